//! All of a picture but the mesh and its material.

use crate::camera::Camera;
use crate::light::{Environment, Light};

/// Lights, environment, coat and camera, the same for every technique.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Sources of light; the first [`MAX_LIGHTS`](crate::MAX_LIGHTS) count.
    pub lights: Vec<Light>,
    /// Light from all around.
    pub environment: Environment,
    /// GGX roughness of the smooth dielectric coat over the material, 0 to 1.
    pub roughness: f32,
    /// Where the picture is taken from.
    pub camera: Camera,
}
