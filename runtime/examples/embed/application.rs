//! What an application has before it draws anything of ours: a device, targets, a camera, a cube of its own.

use glam::{Mat4, Vec3, Vec4};
use half::f16;
use subsurf_runtime::wgpu::{self, util::DeviceExt};
use subsurf_scene::View;

/// Colour of the cube: brighter than white, as light of a scene may be.
pub(crate) const CUBE_COLOUR: [f32; 3] = [0.0, 0.0, 4.0];
/// Middle of the cube and half its edge, in mm.
pub(crate) const CUBE: (Vec3, f32) = (Vec3::new(0.0, -7.0, 0.0), 7.0);

const SHADER: &str = "
struct Camera { clip_from_world: mat4x4<f32>, middle: vec4<f32>, colour: vec4<f32> }
@group(0) @binding(0) var<uniform> camera: Camera;
@vertex fn corner(@builtin(vertex_index) k: u32) -> @builtin(position) vec4<f32> {
    let face = k / 6u;
    let quad = (0xDA4u >> ((k % 6u) * 2u)) & 3u;
    var at = vec3<f32>(0.0);
    at[face / 2u] = f32(face & 1u);
    at[(face / 2u + 1u) % 3u] = f32(quad & 1u);
    at[(face / 2u + 2u) % 3u] = f32(quad >> 1u);
    return camera.clip_from_world * vec4<f32>(camera.middle.xyz + (2.0 * at - 1.0) * camera.middle.w, 1.0);
}
@fragment fn paint() -> @location(0) vec4<f32> { return camera.colour; }
";

/// Application: its device, what it draws to, and its cube.
pub(crate) struct Application {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) info: wgpu::AdapterInfo,
    pub(crate) colour: wgpu::Texture,
    pub(crate) depth: wgpu::TextureView,
    cube: wgpu::RenderPipeline,
    camera: wgpu::BindGroup,
}

type Failed = Box<dyn std::error::Error>;

/// Camera whose middle is not that of its picture, as tiles of a wall and the eyes of a headset have it; depth is 1 at the
/// near plane and 0 far away.
pub(crate) fn view() -> View {
    let (near, [left, right, bottom, top]) = (1.0, [-0.34, 0.26, -0.25, 0.20]);
    let clip_from_view = Mat4::from_cols(
        Vec4::new(2.0 * near / (right - left), 0.0, 0.0, 0.0),
        Vec4::new(0.0, 2.0 * near / (top - bottom), 0.0, 0.0),
        Vec4::new((right + left) / (right - left), (top + bottom) / (top - bottom), 0.0, -1.0),
        Vec4::new(0.0, 0.0, near, 0.0),
    );
    let eye_mm = Vec3::new(25.0, 18.0, 60.0);
    View { view_from_world: glam::camera::rh::view::look_at_mat4(eye_mm, Vec3::ZERO, Vec3::Y), clip_from_view }
}

impl Application {
    /// Opens a device of one of these APIs, and makes what is drawn to.
    pub(crate) fn open(
        backends: wgpu::Backends,
        size: [u32; 2],
        format: wgpu::TextureFormat,
        depth: wgpu::TextureFormat,
    ) -> Result<Self, Failed> {
        let any = wgpu::InstanceDescriptor::new_without_display_handle();
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor { backends, ..any });
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
        // What every phone and every browser has.
        let required_limits = wgpu::Limits::downlevel_webgl2_defaults();
        let wanted = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
        let (device, queue) = pollster::block_on(adapter.request_device(&wanted))?;
        let texture = |format| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        };
        let source = wgpu::ShaderSource::Wgsl(SHADER.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let cube = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("cube"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: depth,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let (middle, half) = CUBE;
        let [r, g, b] = CUBE_COLOUR;
        let mut block = view().clip_from_world().to_cols_array().to_vec();
        block.extend([middle.x, middle.y, middle.z, half, r, g, b, 1.0]);
        let block = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&block),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let camera = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &cube.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: block.as_entire_binding() }],
        });
        let (colour, depth) = (texture(format), texture(depth).create_view(&Default::default()));
        Ok(Self { info: adapter.get_info(), colour, depth, cube, camera, device, queue })
    }

    /// Records the application's own pass, which clears colour and depth.
    pub(crate) fn draw_cube(&self, encoder: &mut wgpu::CommandEncoder) {
        let ops = |load| wgpu::Operations { load, store: wgpu::StoreOp::Store };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("cube"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.colour.create_view(&Default::default()),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(ops(wgpu::LoadOp::Clear(0.0))),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.cube);
        pass.set_bind_group(0, &self.camera, &[]);
        pass.draw(0..36, 0..1);
    }

    /// Waits, and reads the colour back: linear red, green, blue and coverage, row by row from the top.
    pub(crate) fn read(&self) -> Result<Vec<[f32; 4]>, Failed> {
        let [width, height] = [self.colour.width(), self.colour.height()];
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(width) * u64::from(height) * 8,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        // Rows must be multiples of 256 bytes: pictures are multiples of 32 pixels wide.
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 8), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(self.colour.as_image_copy(), to, self.colour.size());
        self.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |mapped| mapped.expect("the buffer can be mapped"));
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let bytes = buffer.get_mapped_range(..)?;
        let texels = bytes.as_chunks::<8>().0.iter().map(|texel| bytemuck::pod_read_unaligned::<[u16; 4]>(texel));
        Ok(texels.map(|texel| texel.map(|bits| f16::from_bits(bits).to_f32())).collect())
    }
}
