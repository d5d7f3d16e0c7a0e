//! Meshes to measure.

use std::path::Path;

use subsurf_scene::{Mesh, UpAxis, load_mesh};

/// Longest side of all meshes, in mm.
pub(super) const EXTENT_MM: f32 = 60.0;

/// Name of a file without folder and extension.
pub(super) fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// Mesh of a file, or a shape, and its name.
pub(super) fn named(path: &Path) -> anyhow::Result<(String, Mesh)> {
    Ok((stem(path), load_mesh(path, EXTENT_MM, UpAxis::Y)?))
}
