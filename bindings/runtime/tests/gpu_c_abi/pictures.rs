//! What `check.c` has to draw, by the renderer itself.

use glam::Vec3;
use glam::camera::rh::proj::directx::perspective;
use glam::camera::rh::view::look_at_mat4;
use subsurf_decoder::{Content, File};
use subsurf_runtime::wgpu::{Color, LoadOp};
use subsurf_runtime::{
    Backend, Gpu, GpuMesh, Input, Load, Material, Object, PictureTarget, Renderer, RuntimeOptions, Target, VertexData,
};
use subsurf_scene::{Environment, Light, LightShape, Lighting, Mapping, Shadow, View, sphere};

/// Pixels of the pictures, as in `check.h`.
const SIZE: [u32; 2] = [96, 72];

/// Display values of the frame of `check.h`, red, green, blue and coverage, rows from the top. `splats`: the slower technique.
pub(crate) fn of(bytes: &[u8], backend: Backend, splats: bool) -> Vec<[u8; 4]> {
    let gpu = Gpu::open(backend).unwrap_or_else(|error| panic!("{error}: run `make test`, which installs one"));
    let file = File::parse(bytes).expect("a file of our own");
    let material = match file.content() {
        Content::Bssrdf(material) if splats => Load::splat(&gpu, &material).unwrap().finish().unwrap().into(),
        _ => Material::load(&gpu, &file).unwrap(),
    };
    let mesh = sphere(1.0, 48).fitted(40.0).unwrap();
    let tangents = mesh.tangents().unwrap();
    let known = VertexData { tangents: Some(&tangents), ..Default::default() };
    let mesh = GpuMesh::upload(&gpu, &mesh, known).unwrap();
    let shape = LightShape::Directional { towards: Vec3::new(0.9, 1.1, 0.35) };
    let lights = [Light { shape, irradiance: [3.0, 2.9, 2.7], shadow: Shadow::Drawn }];
    let environment = Environment::uniform([0.35, 0.4, 0.5]);
    let eye_mm = Vec3::new(40.0, 24.0, 64.0);
    let view = View {
        view_from_world: look_at_mat4(eye_mm, eye_mm + (-eye_mm).normalize(), Vec3::Y),
        clip_from_view: perspective(0.5, SIZE[0] as f32 / SIZE[1] as f32, 1.0, 200.0),
    };
    let objects = [Object::new(&mesh, &material, Mapping::Uv([2.0, 1.0]), 0.25)];
    let lighting = Lighting { lights: &lights, environment: &environment, reference_mm: Vec3::ZERO };
    let input = Input { view, exposure: 1.0, lighting, shadow_maps: &[], objects: &objects };
    let renderer = Renderer::for_technique(&gpu, material.technique(), RuntimeOptions::default()).unwrap();
    let picture = PictureTarget::new(&gpu, SIZE, renderer.options()).unwrap();
    let mut frame = renderer.prepare(&gpu, &input, SIZE).unwrap();
    let [r, g, b] = [0.2_f32, 0.4, 0.6].map(f64::from);
    let target = Target { load: LoadOp::Clear(Color { r, g, b, a: 1.0 }), ..picture.target() };
    renderer.draw_now(&gpu, &mut frame, &input, &target).unwrap();
    picture.read(&gpu).unwrap()
}
