//! A material on a mesh, drawn with a device, a queue and a texture that an application has of its own.
//!
//! `cargo run --release -p subsurf-runtime --example embed -- jade.subsurf`

use subsurf_decoder::Bssrdf;
use subsurf_runtime::{
    Drawable, Gpu, GpuMesh, Renderer, RuntimeOptions, SeparableMaterial, Technique, VertexData, wgpu,
};
use subsurf_scene::{Camera, Environment, Light, LightShape, Mapping, Placement, Scene, torus};
use subsurf_shaders::separable::ProjectedBasis;

const SIZE: [u32; 2] = [640, 480];
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("which material? embed FILE.subsurf")?;

    // What an application has already.
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let limits = wgpu::Limits::downlevel_webgl2_defaults().using_resolution(adapter.limits());
    let wanted = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&wanted))?;
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("the application's picture"),
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });

    // Once, at load: check the file, upload material and mesh, compile the passes.
    let gpu = Gpu::from_device(device.clone(), queue.clone(), adapter.get_info());
    let bytes = std::fs::read(file)?;
    let bssrdf = Bssrdf::parse(&bytes)?;
    let mesh = torus(18.0, 8.0, 64);
    let placement = Placement::new(&mesh, Mapping::Box, bssrdf.header());
    let mesh = GpuMesh::upload(&gpu, &mesh, &placement, VertexData::Nothing)?;
    let basis = ProjectedBasis::of(&bssrdf).ok_or("no separable basis: `subsurf encode --add-basis FILE` adds one")?;
    let material = SeparableMaterial::upload(&gpu, &basis)?;
    let model = Drawable::Separable { mesh: &mesh, material: &material };
    let options = RuntimeOptions { format: FORMAT, samples: 4, ..Default::default() };
    let renderer = Renderer::new(&gpu, Technique::Separable(material.terms()), options)?;

    // Again when the size changes: room for the passes of a frame.
    let [eye_mm, target_mm] = [[55.0, 60.0, 80.0], [0.0; 3]].map(Into::into);
    let mut scene = Scene {
        lights: vec![Light {
            shape: LightShape::Directional { towards: [0.9, 1.1, 0.35].into() },
            irradiance: [3.0, 2.9, 2.7],
        }],
        environment: Environment::uniform([0.35, 0.4, 0.5]),
        roughness: 0.25,
        camera: Camera { eye_mm, target_mm, fov_y_rad: 0.5, exposure: 0.5 },
    };
    let mut frame = renderer.prepare(&gpu, &model, &scene, SIZE)?;

    // Every frame: lights, view, coat and environment may all have changed.
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    for step in 0..3_u8 {
        scene.roughness = 0.2 + 0.1 * f32::from(step);
        renderer.draw(&gpu, &mut frame, &model, &scene, &view)?;
    }

    let pixels = read_back(&device, &queue, &texture)?;
    let background = subsurf_runtime::BACKGROUND;
    let drawn: Vec<_> = pixels.iter().filter(|pixel| pixel[..3] != [background; 3]).collect();
    assert!(drawn.len() > pixels.len() / 10, "{} of {} pixels show the torus", drawn.len(), pixels.len());
    let mean = |c: usize| drawn.iter().map(|pixel| usize::from(pixel[c])).sum::<usize>() / drawn.len();
    println!("{}: the torus covers {} pixels, mean {:?}", adapter.get_info().name, drawn.len(), [0, 1, 2].map(mean));
    println!("{} bytes on the device", gpu.ledger().bytes());
    Ok(())
}

/// Nothing of this library: how wgpu hands out the texels of a texture, four bytes each.
fn read_back(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
) -> Result<Vec<[u8; 4]>, Box<dyn std::error::Error>> {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(SIZE[0] * SIZE[1] * 4),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    // Rows must be multiples of 256 bytes, as those of 640 pixels are.
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE[0] * 4), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
    queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |mapped| mapped.expect("the buffer can be mapped"));
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let bytes = buffer.get_mapped_range(..)?;
    Ok(bytes.as_chunks::<4>().0.to_vec())
}
