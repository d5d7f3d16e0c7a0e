//! Meshes as files have them, before they are checked.

use glam::{Vec2, Vec3};

/// Result of a reader; the error says what is wrong with the file.
pub(super) type Result<T> = std::result::Result<T, String>;

/// Vertices and triangles in the file's own unit.
#[derive(Debug, Default)]
pub(super) struct Raw {
    pub(super) positions: Vec<Vec3>,
    /// One for each vertex, or none.
    pub(super) normals: Vec<Vec3>,
    /// v upwards.
    pub(super) uvs: Option<Vec<Vec2>>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// A number of vertices, as indices count them.
pub(super) fn count(n: usize) -> Result<u32> {
    u32::try_from(n).map_err(|_| "more than 2³² vertices".to_owned())
}
