//! Bounds of meshes.

use glam::Vec3;

/// Sphere that holds a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Middle of the mesh's bounding box, in mm.
    pub centre_mm: Vec3,
    /// Distance of the furthest vertex from there, in mm; at least 0.001.
    pub radius_mm: f32,
}
