//! All of a picture but the mesh and its material.

use glam::Vec3;

use crate::camera::Camera;
use crate::light::{Environment, Light};

/// Lights, environment, coat and camera, the same for every technique.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Sources of light, at most [`MAX_LIGHTS`](crate::MAX_LIGHTS).
    pub lights: Vec<Light>,
    /// Light from all around.
    pub environment: Environment,
    /// GGX roughness of the smooth dielectric coat over the material, 0 to 1.
    pub roughness: f32,
    /// Where the picture is taken from.
    pub camera: Camera,
}

/// Light that falls on the objects of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Lighting<'a> {
    /// Sources of light, at most [`MAX_LIGHTS`](crate::MAX_LIGHTS).
    pub lights: &'a [Light],
    /// Light from all around.
    pub environment: &'a Environment,
    /// Point in mm at which lights from nearby have the irradiance that they name.
    pub reference_mm: Vec3,
}

impl Scene {
    /// Lights and environment, when lights from nearby have their irradiance at `reference_mm`.
    #[must_use]
    pub fn lighting(&self, reference_mm: Vec3) -> Lighting<'_> {
        Lighting { lights: &self.lights, environment: &self.environment, reference_mm }
    }
}
