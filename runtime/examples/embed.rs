//! Translucent and textured meshes in an application's own frame: its device, its encoder, its depth, its camera.
//!
//! `cargo run --release -p subsurf-runtime --example embed -- jade.subsurf leather.subsurf`

use glam::{Mat4, Vec3};
use subsurf_decoder::File;
use subsurf_runtime::wgpu::{Backends, LoadOp, Operations, StoreOp, TextureFormat};
use subsurf_runtime::{
    DepthFormat, Gpu, GpuMesh, Input, Material, Object, Renderer, RuntimeOptions, Target, VertexData,
};
use subsurf_scene::{Environment, Light, LightShape, Lighting, Mapping, Shadow, sphere};

#[path = "embed/application.rs"]
mod application;
use application::Application;

const SIZE: [u32; 2] = [640, 480];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let files: Vec<String> = std::env::args().skip(1).collect();
    let [jade, leather] = &files[..] else {
        return Err("which materials? embed BSSRDF.subsurf BTF.subsurf".into());
    };

    // What an application has already: here linear light without a limit, and depth that is 1 near and 0 far.
    let colour = TextureFormat::Rgba16Float;
    let depth = DepthFormat { format: TextureFormat::Depth32Float, is_reversed: true };
    let app = Application::open(Backends::all().with_env(), SIZE, colour, depth.format)?;

    // Once, at load: check the files, upload materials and meshes, compile the passes.
    let gpu = Gpu::from_device(app.device.clone(), app.queue.clone(), app.info.clone());
    let (jade, leather) = (std::fs::read(jade)?, std::fs::read(leather)?);
    let jade = Material::load(&gpu, &File::parse(&jade)?)?;
    let leather = Material::load(&gpu, &File::parse(&leather)?)?;
    let mesh = sphere(8.0, 48);
    let tangents = mesh.tangents()?;
    let mesh = GpuMesh::upload(&gpu, &mesh, VertexData { tangents: Some(&tangents), ..Default::default() })?;
    let options = RuntimeOptions { format: colour, depth, tone_mapping: false, ..Default::default() };
    let mut renderer = Renderer::new(&gpu, options)?;
    for material in [&jade, &leather] {
        renderer.compile(&gpu, material.technique())?;
    }

    // Objects may come, go and move with every frame.
    let mut objects =
        [Object::new(&mesh, &jade, Mapping::Box, 0.25), Object::new(&mesh, &leather, Mapping::Uv([6.0, 3.0]), 1.0)];
    let towards = Vec3::new(0.9, 1.1, 0.35);
    let lights =
        [Light { shape: LightShape::Directional { towards }, irradiance: [3.0, 2.9, 2.7], shadow: Shadow::Drawn }];
    let environment = Environment::uniform([0.35, 0.4, 0.5]);
    let lighting = Lighting { lights: &lights, environment: &environment, reference_mm: Vec3::ZERO };
    let view = application::view();
    let input = Input { view, exposure: 1.0, lighting, shadow_maps: &[], objects: &objects };

    // Again when the size or the materials change: room for the passes of a frame.
    let mut frame = renderer.prepare(&gpu, &input, SIZE)?;

    for step in 0..3_u8 {
        objects[1].world_from_mesh = Mat4::from_translation(Vec3::new(9.0 - f32::from(step), 0.0, 2.0));
        let mut encoder = app.device.create_command_encoder(&Default::default());
        app.draw_cube(&mut encoder);
        let target = Target {
            colour: &app.colour.create_view(&Default::default()),
            load: LoadOp::Load,
            resolve: None,
            depth: &app.depth,
            depth_ops: Operations { load: LoadOp::Load, store: StoreOp::Store },
            origin: [0; 2],
        };
        let input = Input { view, exposure: 1.0, lighting, shadow_maps: &[], objects: &objects };
        renderer.draw(&gpu, &mut encoder, &mut frame, &input, &target)?;
        app.queue.submit([encoder.finish()]);
    }

    let pixels = app.read()?;
    let covered = |is: &dyn Fn([f32; 3]) -> bool| {
        pixels.iter().filter(|[r, g, b, covered]| *covered > 0.0 && is([*r, *g, *b])).count()
    };
    let is_cube = |colour: [f32; 3]| colour == application::CUBE_COLOUR;
    let [cube, ours] = [covered(&is_cube), covered(&|colour| !is_cube(colour))];
    println!("{}: {ours} pixels of ours, {cube} of the cube, {} bytes", app.info.name, gpu.ledger().bytes());
    assert!(ours > 10_000 && cube > 10_000, "both are in the picture");
    Ok(())
}
