//! Where a picture is taken from.

use glam::Vec3;

/// Pinhole camera, upright: y is up in the picture, or z where it looks along y.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// Position of the eye, in mm.
    pub eye_mm: Vec3,
    /// Point in the middle of the picture, in mm.
    pub target_mm: Vec3,
    /// Vertical field of view, from the lower edge to the upper, in radians.
    pub fov_y_rad: f32,
    /// Factor on radiance before tone mapping.
    pub exposure: f32,
}
