//! Depth map of an application's own: spheres as a light sees them.

use glam::{Mat4, Vec3};
use subsurf_runtime::wgpu::{self, util::DeviceExt};
use subsurf_scene::sphere;

use super::application::Application;

const SHADER: &str = "
struct Camera { clip_from_world: mat4x4<f32> }
@group(0) @binding(0) var<uniform> camera: Camera;
@vertex fn project(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> {
    return camera.clip_from_world * vec4<f32>(position, 1.0);
}
";

/// Texels to a side.
const SIDE: u32 = 512;

/// Depth map.
pub(crate) struct HostMap(wgpu::TextureView);

impl HostMap {
    /// Draws spheres, in a submission of its own.
    pub(crate) fn draw(
        app: &Application,
        radius: f32,
        centres: &[Vec3],
        clip_from_world: Mat4,
        format: wgpu::TextureFormat,
        is_reversed: bool,
    ) -> Self {
        let device = &app.device;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let source = wgpu::ShaderSource::Wgsl(SHADER.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: 12,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x3],
                })],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(if is_reversed {
                    wgpu::CompareFunction::Greater
                } else {
                    wgpu::CompareFunction::Less
                }),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        });
        let ball = sphere(radius, 64);
        let corners = ball.triangles.iter().flatten().map(|k| ball.positions[*k as usize]);
        let corners: Vec<Vec3> = centres.iter().flat_map(|centre| corners.clone().map(move |at| at + centre)).collect();
        let buffer = |contents, usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
        };
        let vertices = buffer(bytemuck::cast_slice(&corners), wgpu::BufferUsages::VERTEX);
        let camera = buffer(bytemuck::bytes_of(&clip_from_world), wgpu::BufferUsages::UNIFORM);
        let camera = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: camera.as_entire_binding() }],
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(if is_reversed { 0.0 } else { 1.0 }),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &camera, &[]);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.draw(0..u32::try_from(corners.len()).unwrap(), 0..1);
        drop(pass);
        app.queue.submit([encoder.finish()]);
        Self(view)
    }

    pub(crate) fn view(&self) -> &wgpu::TextureView {
        &self.0
    }
}
