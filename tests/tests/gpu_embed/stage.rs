//! An application's stage: its device and targets, with a jade sphere and a leather one of ours.

use glam::{Mat4, Vec3};
use subsurf_decoder::{Bssrdf, File};
use subsurf_encoder::synthetic::NestedShape;
use subsurf_runtime::wgpu::{self, Backends, Color, LoadOp, Operations, StoreOp, TextureFormat};
use subsurf_runtime::{
    BtfOptions, DepthFormat, Gpu, GpuMesh, Input, Load, Material, Object, Renderer, RuntimeOptions, Target, VertexData,
};
use subsurf_scene::{AmbientTransfer, Environment, Light, LightShape, Lighting, Mapping, Shadow, View, sphere};
use subsurf_tests::frames::material_of;

use super::application::Application;

pub(crate) const SIZE: [u32; 2] = [320, 240];
const COLOUR: TextureFormat = TextureFormat::Rgba16Float;
pub(crate) const DEPTH: DepthFormat = DepthFormat { format: TextureFormat::Depth32Float, is_reversed: true };
/// Radius of the meshes in mm.
pub(crate) const RADIUS: f32 = 8.0;
/// Where the BTF lies.
pub(crate) const LEATHER_AT: Vec3 = Vec3::new(9.0, 0.0, 2.0);

/// Application with a jade sphere and a leather one.
pub(crate) struct Stage {
    pub(crate) app: Application,
    pub(crate) gpu: Gpu,
    pub(crate) renderer: Renderer,
    pub(crate) mesh: GpuMesh,
    pub(crate) jade: Material,
    pub(crate) splats: Material,
    pub(crate) leather: Material,
}

impl Stage {
    pub(crate) fn open(backends: Backends) -> Self {
        Self::with(backends, RuntimeOptions::default())
    }

    /// Stage whose renderer has some options; what is drawn to is that of the stage.
    pub(crate) fn with(backends: Backends, options: RuntimeOptions) -> Self {
        let app = Application::open(backends, SIZE, COLOUR, DEPTH.format).unwrap();
        let gpu = Gpu::from_device(app.device.clone(), app.queue.clone(), app.info.clone());
        let (file, btf) = (material_of("jade"), NestedShape::typical().database(1).to_bytes());
        let load = |bytes| Material::load(&gpu, &File::parse(bytes).unwrap()).unwrap();
        let (jade, leather) = (load(&file), load(&btf));
        let file = Bssrdf::parse(&file).unwrap();
        let mesh = sphere(RADIUS, 64);
        let (ambient, tangents) = (AmbientTransfer::of(&mesh, &file).unwrap(), mesh.tangents().unwrap());
        let known = VertexData { ambient: Some(&ambient), tangents: Some(&tangents), points: None };
        let mesh = GpuMesh::upload(&gpu, &mesh, known).unwrap();
        let splats: Material = Load::splat(&gpu, &file).unwrap().finish().unwrap().into();
        // Light from all around that has no grain, so that pictures can be compared bit for bit.
        let btf = BtfOptions { samples: 0, ..BtfOptions::default() };
        let options = RuntimeOptions { format: COLOUR, depth: DEPTH, tone_mapping: false, btf, ..options };
        let mut renderer = Renderer::new(&gpu, options).unwrap();
        for material in [&jade, &splats, &leather] {
            renderer.compile(&gpu, material.technique()).unwrap();
        }
        Self { app, gpu, renderer, mesh, jade, splats, leather }
    }

    /// Target of the application, drawn over what is there.
    pub(crate) fn over<'a>(&'a self, colour: &'a wgpu::TextureView) -> Target<'a> {
        Target {
            colour,
            load: LoadOp::Load,
            resolve: None,
            depth: &self.app.depth,
            depth_ops: Operations { load: LoadOp::Load, store: StoreOp::Store },
            origin: [0; 2],
        }
    }

    pub(crate) fn jade(&self) -> Object<'_> {
        Object::new(&self.mesh, &self.jade, Mapping::Box, 0.25)
    }

    pub(crate) fn leather(&self) -> Object<'_> {
        let at = Mat4::from_translation(LEATHER_AT);
        Object { world_from_mesh: at, ..Object::new(&self.mesh, &self.leather, Mapping::Uv([6.0, 3.0]), 1.0) }
    }

    /// One submission with the cube and some objects under a view.
    pub(crate) fn draw(&self, view: View, objects: &[Object<'_>], lights: &[Light], has_cube: bool) -> Vec<[f32; 4]> {
        self.draw_part(view, objects, lights, has_cube, [[0; 2], SIZE])
    }

    /// The same in a part of the target, from a pixel on and of a size.
    pub(crate) fn draw_part(
        &self,
        view: View,
        objects: &[Object<'_>],
        lights: &[Light],
        has_cube: bool,
        [origin, size]: [[u32; 2]; 2],
    ) -> Vec<[f32; 4]> {
        let environment = Environment::uniform([0.35, 0.4, 0.5]);
        let lighting = Lighting { lights, environment: &environment, reference_mm: Vec3::ZERO };
        let input = Input { view, exposure: 1.0, lighting, shadow_maps: &[], objects };
        self.draw_input(&input, has_cube, [origin, size])
    }

    /// One submission with whatever an input has.
    pub(crate) fn draw_input(&self, input: &Input<'_>, has_cube: bool, [origin, size]: [[u32; 2]; 2]) -> Vec<[f32; 4]> {
        let mut frame = self.renderer.prepare(&self.gpu, input, size).unwrap();
        let mut encoder = self.app.device.create_command_encoder(&Default::default());
        let clear = LoadOp::Clear(Color::TRANSPARENT);
        let (mut load, mut load_depth) = (clear, LoadOp::Clear(DEPTH.furthest()));
        if has_cube {
            self.app.draw_cube(&mut encoder);
            (load, load_depth) = (LoadOp::Load, LoadOp::Load);
        }
        let colour = self.app.colour.create_view(&wgpu::TextureViewDescriptor::default());
        let depth_ops = Operations { load: load_depth, store: StoreOp::Store };
        let target = Target { load, depth_ops, origin, ..self.over(&colour) };
        let scope = self.app.device.push_error_scope(wgpu::ErrorFilter::Validation);
        self.renderer.draw(&self.gpu, &mut encoder, &mut frame, input, &target).unwrap();
        self.app.queue.submit([encoder.finish()]);
        let complaint = pollster::block_on(scope.pop());
        assert!(complaint.is_none(), "{complaint:?}");
        self.app.read().unwrap()
    }
}

pub(crate) fn luminance(pixels: &[[f32; 4]]) -> f64 {
    pixels.iter().map(|[r, g, b, _]| f64::from(r + g + b)).sum()
}

/// White light from afar, with a shadow.
pub(crate) fn sun_from(towards: Vec3) -> Light {
    Light { shape: LightShape::Directional { towards }, irradiance: [3.0; 3], shadow: Shadow::Drawn }
}

/// Sun from above and from the left.
pub(crate) fn sun() -> Light {
    sun_from(Vec3::new(-1.0, 0.6, 0.5))
}
