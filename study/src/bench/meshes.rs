//! Meshes to measure.

use std::path::Path;

use subsurf_scene::{Mesh, UpAxis, load_mesh};
use subsurf_viewer::stem;

/// Longest side of all meshes, in mm.
pub(super) const EXTENT_MM: f32 = 60.0;

/// Mesh of a file, or a shape, and its name.
pub(super) fn named(path: &Path) -> anyhow::Result<(String, Mesh)> {
    Ok((stem(path), load_mesh(path, EXTENT_MM, UpAxis::Y)?.mesh))
}
