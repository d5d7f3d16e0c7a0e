//! Pictures of meshes: from where, in which light, how large.

use glam::Vec3;
use subsurf_runtime::RuntimeOptions;
use subsurf_scene::{BoundingSphere, Camera, Environment, Light, LightShape, Mesh, Scene, Shadow};

use crate::set::{Angles, Set};

/// Roughness of the usual coat, 0 to 1: polished, but not a mirror.
pub const ROUGHNESS: f32 = 0.25;

/// Picture of a mesh, as it is asked for.
pub struct RenderRequest {
    /// What stands around the mesh.
    pub set: Set,
    /// Direction towards the light, of length 1.
    pub direction: Vec3,
    /// Light from all around.
    pub environment: Environment,
    /// Roughness of the coat of a translucent material, 0 to 1.
    pub roughness: f32,
    /// Position of the eye.
    pub angles: Angles,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Factor of light before tone mapping; chosen from the picture if `None`.
    pub exposure: Option<f32>,
    /// Choices of the renderer.
    pub options: RuntimeOptions,
}

impl RenderRequest {
    /// A mesh alone in the studio, in a picture of `size` pixels.
    #[must_use]
    pub fn usual(size: [u32; 2]) -> Self {
        Self::of(Set::Studio, size)
    }

    /// Light, surroundings and eye of a set, in a picture of `size` pixels.
    #[must_use]
    pub fn of(set: Set, size: [u32; 2]) -> Self {
        Self {
            set,
            direction: set.towards_light(),
            environment: set.environment(),
            roughness: ROUGHNESS,
            angles: set.angles(),
            size,
            exposure: None,
            options: RuntimeOptions { light_texels: set.light_texels(), ..RuntimeOptions::default() },
        }
    }

    /// The scene in which a mesh fills the picture; of its ground, which [`Set::with_ground`] adds, as much as there is room for.
    #[must_use]
    pub fn scene(&self, mesh: &Mesh) -> Scene {
        self.scene_around(&mesh.bounding_sphere())
    }

    /// The scene in which a sphere fills the picture.
    pub(crate) fn scene_around(&self, bounds: &BoundingSphere) -> Scene {
        Scene {
            lights: vec![Light {
                shape: LightShape::Directional { towards: self.direction },
                irradiance: self.set.irradiance(),
                shadow: Shadow::Drawn,
            }],
            environment: self.environment.clone(),
            roughness: self.roughness,
            camera: framed(&self.set.framed(bounds), self.angles, self.size),
        }
    }
}

/// A view in which a sphere fills a picture of `size`.
fn framed(bounds: &BoundingSphere, angles: Angles, size: [u32; 2]) -> Camera {
    const ANGLE: f32 = 0.5;
    let target_mm = bounds.centre_mm;
    let (around, up) = (angles.around.to_radians(), angles.up.to_radians());
    let towards = Vec3::new(up.cos() * around.sin(), up.sin(), up.cos() * around.cos());
    #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
    let aspect = (size[0] as f32 / size[1] as f32).min(1.0);
    let distance = 1.02 * bounds.radius_mm / (0.5 * ANGLE).sin() / aspect;
    Camera { eye_mm: target_mm + distance * towards, target_mm, fov_y_rad: ANGLE, exposure: 1.0 }
}
