//! Pictures of meshes: from where, in which light, how large.

use glam::Vec3;
use subsurf_runtime::RuntimeOptions;
use subsurf_scene::{Camera, Environment, Light, LightShape, Mesh, Scene, Shadow};

/// Direction towards the usual light, not normalised: over the right shoulder.
pub const DEFAULT_LIGHT: Vec3 = Vec3::new(0.9, 1.1, 0.35);
/// Roughness of the usual coat, 0 to 1: polished, but not a mirror.
pub const ROUGHNESS: f32 = 0.25;
/// Irradiance of the usual light on a plane that faces it, linear Rec. 709.
const IRRADIANCE: [f32; 3] = [3.0, 2.9, 2.7];

/// Position of the eye around a mesh, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angles {
    /// Around the up axis, from z towards x.
    pub around: f32,
    /// Above the horizon, between −90 and 90.
    pub up: f32,
}

/// Picture of a mesh, as it is asked for.
pub struct RenderRequest {
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
    /// The usual light, surroundings and eye, in a picture of `size` pixels.
    #[must_use]
    pub fn usual(size: [u32; 2]) -> Self {
        Self {
            direction: DEFAULT_LIGHT.normalize(),
            environment: Environment::studio(),
            roughness: ROUGHNESS,
            angles: Angles { around: 30.0, up: 15.0 },
            size,
            exposure: None,
            options: RuntimeOptions::default(),
        }
    }

    /// The scene in which a mesh fills the picture.
    #[must_use]
    pub fn scene(&self, mesh: &Mesh) -> Scene {
        Scene {
            lights: vec![Light {
                shape: LightShape::Directional { towards: self.direction },
                irradiance: IRRADIANCE,
                shadow: Shadow::Drawn,
            }],
            environment: self.environment.clone(),
            roughness: self.roughness,
            camera: framed(mesh, self.angles, self.size),
        }
    }
}

/// A view in which the mesh fills a picture of `size`.
fn framed(mesh: &Mesh, angles: Angles, size: [u32; 2]) -> Camera {
    const ANGLE: f32 = 0.5;
    let [low, high] = mesh.bounds();
    let target_mm = 0.5 * (low + high);
    let (around, up) = (angles.around.to_radians(), angles.up.to_radians());
    let towards = Vec3::new(up.cos() * around.sin(), up.sin(), up.cos() * around.cos());
    let radius = mesh.positions.iter().map(|position| position.distance(target_mm)).fold(0.0, f32::max);
    #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
    let aspect = (size[0] as f32 / size[1] as f32).min(1.0);
    let distance = 1.02 * radius / (0.5 * ANGLE).sin() / aspect;
    Camera { eye_mm: target_mm + distance * towards, target_mm, fov_y_rad: ANGLE, exposure: 1.0 }
}
