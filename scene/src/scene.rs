//! Lights, environment, coat and eye: all of a picture but the mesh and its material.

use glam::Vec3;

use crate::light::{Environment, Light};

/// Lights, environment, coat and eye, the same for every path.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The first four count.
    pub lights: Vec<Light>,
    /// Light from all around.
    pub environment: Environment,
    /// GGX roughness of the smooth dielectric coat over the scattering, 0 to 1.
    pub roughness: f32,
    /// Where the picture is taken from.
    pub view: View,
}

/// Where a picture is taken from.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Eye, in mm.
    pub eye_mm: Vec3,
    /// What the eye looks at, in mm.
    pub target_mm: Vec3,
    /// Vertical angle of view in radians.
    pub angle: f32,
    /// Multiplies radiance before tone mapping.
    pub exposure: f32,
}
