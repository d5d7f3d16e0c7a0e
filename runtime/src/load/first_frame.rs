//! First frames of timed loads: a small picture of what was loaded.

use glam::Vec3;
use subsurf_scene::{Camera, Environment, Light, LightShape, Mapping, Scene, Shadow, relief};

use crate::asset::{BssrdfPlanes, GpuMesh, Material, VertexData};
use crate::error::Result;
use crate::frame::{Input, Object, PictureTarget, Renderer, RuntimeOptions};
use crate::gpu::Gpu;
use crate::technique::{PatchLight, PatchRenderer, Region, Technique};

/// Pixels to a side.
const FRAME: u32 = 64;
/// Copies of a material on the mesh.
const COPIES: [f32; 2] = [4.0; 2];
/// Radius of the mesh in mm.
const RADIUS_MM: f32 = 20.0;

/// Mesh under a light, with the pipelines of a technique.
pub(super) struct Stage {
    renderer: Renderer,
    mesh: GpuMesh,
    scene: Scene,
}

impl Stage {
    pub(super) fn new(gpu: &Gpu, technique: Technique) -> Result<Self> {
        let mesh = relief(RADIUS_MM, 8, 22);
        let tangents = mesh.tangents()?;
        let known = VertexData { tangents: Some(&tangents), ..Default::default() };
        Self::of(gpu, technique, GpuMesh::upload(gpu, &mesh, known)?, (Vec3::ZERO, RADIUS_MM))
    }

    /// The same with a mesh of the caller's, for what needs to know nothing of its vertices.
    #[cfg(feature = "transfer")]
    pub(super) fn on(gpu: &Gpu, technique: Technique, mesh: &subsurf_scene::Mesh) -> Result<Self> {
        let bounds = mesh.bounding_sphere();
        let mesh = GpuMesh::upload(gpu, mesh, VertexData::default())?;
        Self::of(gpu, technique, mesh, (bounds.centre_mm, bounds.radius_mm))
    }

    /// A mesh about a centre, of so many mm.
    fn of(gpu: &Gpu, technique: Technique, mesh: GpuMesh, (centre_mm, radius_mm): (Vec3, f32)) -> Result<Self> {
        let shape = LightShape::Directional { towards: Vec3::new(0.9, 1.1, 0.35) };
        Ok(Self {
            renderer: Renderer::for_technique(gpu, technique, RuntimeOptions::default())?,
            mesh,
            scene: Scene {
                lights: vec![Light { shape, irradiance: [3.0, 2.9, 2.7], shadow: Shadow::Drawn }],
                environment: Environment::uniform([0.35, 0.4, 0.5]),
                roughness: 0.25,
                camera: Camera {
                    eye_mm: centre_mm + 4.2 * radius_mm * Vec3::new(0.5, 0.3, 0.8).normalize(),
                    target_mm: centre_mm,
                    fov_y_rad: 0.5,
                    exposure: 1.0,
                },
            },
        })
    }

    /// Makes room for a frame, draws it, and waits until it is done.
    pub(super) fn draw(&self, gpu: &Gpu, material: &Material) -> Result<()> {
        let objects = [Object::new(&self.mesh, material, Mapping::Uv(COPIES), self.scene.roughness)];
        let input = Input::new(&self.scene, &objects, [FRAME; 2]);
        let picture = PictureTarget::new(gpu, [FRAME; 2], self.renderer.options())?;
        let mut frame = self.renderer.prepare(gpu, &input, [FRAME; 2])?;
        self.renderer.draw_now(gpu, &mut frame, &input, &picture.target())?;
        gpu.finish()
    }
}

/// Gathers the middle of a flat patch under uniform light, and reads its picture back.
pub(super) fn gathered(gpu: &Gpu, renderer: &PatchRenderer, planes: &BssrdfPlanes) -> Result<()> {
    let size = [planes.header().width, planes.header().height];
    let light = PatchLight::upload(gpu, size, &vec![[1.0; 3]; size.map(|side| side as usize).iter().product()])?;
    let frame = size.map(|side| side.min(FRAME));
    let region = Region { origin: [0, 1].map(|k| (size[k] - frame[k]) / 2), size: frame };
    let exitance = renderer.gather(gpu, planes, &light, region)?;
    renderer.picture(gpu, &exitance, frame, 1.0)?;
    Ok(())
}
