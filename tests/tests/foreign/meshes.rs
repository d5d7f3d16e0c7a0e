//! Meshes of every kind.
