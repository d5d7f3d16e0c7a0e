//! Captures, their sidecars, and the images that a command takes.
