//! The scene of all pictures: a ball under two lights in a studio.

use std::sync::LazyLock;

use glam::{Vec3, Vec4};
use subsurf_scene::{
    Camera, Environment, Light, LightShape, MAX_LIGHTS, Mesh, Placement, REFLECTION_SIZE, Scene, Shadow, sphere,
};
use subsurf_shaders::cpu::{KernelMesh, Reflections};
use subsurf_shaders::uniform::Blocks;

/// Pixels of a picture.
pub const SIZE: [u32; 2] = [6, 5];
/// Display value behind the ball.
pub const BACKGROUND: [u8; 3] = [9; 3];

/// Ball and lights.
pub struct Stage {
    pub mesh: Mesh,
    pub scene: Scene,
    /// Unit vectors along the rows of a BTF; see `BtfTriangles`.
    pub tangents: Vec<Vec4>,
    /// All of each light reaches every vertex.
    pub visibilities: Vec<[f32; MAX_LIGHTS]>,
}

/// The only stage.
pub fn stage() -> &'static Stage {
    static STAGE: LazyLock<Stage> = LazyLock::new(|| {
        let light = |shape| Light { shape, irradiance: [2.0, 3.0, 4.0], shadow: Shadow::None };
        let mesh = sphere(5.0, 4);
        Stage {
            visibilities: vec![[1.0; MAX_LIGHTS]; mesh.positions.len()],
            tangents: mesh.tangents().expect("a ball has texture coordinates"),
            mesh,
            scene: Scene {
                lights: vec![
                    light(LightShape::Directional { towards: Vec3::new(0.9, 1.0, 0.3) }),
                    light(LightShape::Directional { towards: Vec3::NEG_X }),
                ],
                environment: Environment::studio(),
                roughness: 0.3,
                camera: Camera {
                    eye_mm: Vec3::new(3.0, 4.0, 22.0),
                    target_mm: Vec3::ZERO,
                    fov_y_rad: 0.6,
                    exposure: 0.5,
                },
            },
        }
    });
    &STAGE
}

impl Stage {
    /// The ball without a material.
    pub fn triangles(&self) -> KernelMesh<'_> {
        KernelMesh { positions: &self.mesh.positions, normals: &self.mesh.normals, triangles: &self.mesh.triangles }
    }

    /// The studio, as it is mirrored.
    pub fn reflections(&self) -> Reflections<'_> {
        Reflections { size: REFLECTION_SIZE, levels: self.scene.environment.reflections() }
    }

    /// Blocks of a picture of the ball with a material on it.
    pub fn blocks(&self, placement: &Placement) -> Blocks {
        Blocks::new(&self.scene, placement, SIZE, 512)
    }
}
