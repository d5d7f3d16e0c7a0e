//! Meshes to measure.

use std::path::Path;

use subsurf_scene::{Mesh, UpAxis, load_mesh};
use subsurf_viewer::stem;

/// Longest side of all meshes in mm, if nothing else is said.
pub(super) const EXTENT_MM: f32 = 60.0;

/// Mesh of a file, or a shape, of a longest side in mm, and its name.
pub(super) fn named(path: &Path, extent_mm: f32) -> anyhow::Result<(String, Mesh)> {
    Ok((stem(path), load_mesh(path, extent_mm, UpAxis::Y)?.mesh))
}
