//! Paints what egui tessellates, within the limits of GLES 3.0.
//!
//! egui's own painter for this version of wgpu asks for a newer compiler than the rest of this workspace.

use std::collections::HashMap;

use egui::epaint::{ImageDelta, Primitive, Vertex};
use egui::{ClippedPrimitive, ImageData, Rect, TextureId, TexturesDelta};
use subsurf_runtime::Gpu;
use subsurf_runtime::wgpu::{
    AddressMode, BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, BlendComponent, BlendFactor, BlendOperation, BlendState,
    Buffer, BufferBindingType, BufferDescriptor, BufferUsages, ColorTargetState, ColorWrites, Extent3d, FilterMode,
    FragmentState, IndexFormat, MultisampleState, Origin3d, PipelineCompilationOptions, PipelineLayoutDescriptor,
    PrimitiveState, RenderPass, RenderPipeline, RenderPipelineDescriptor, Sampler, SamplerBindingType,
    SamplerDescriptor, ShaderModuleDescriptor, ShaderSource, ShaderStages, TexelCopyBufferLayout, TexelCopyTextureInfo,
    Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureSampleType, TextureUsages,
    TextureViewDescriptor, TextureViewDimension, VertexBufferLayout, VertexState, VertexStepMode, vertex_attr_array,
};

/// The panel of one frame, ready to paint.
pub(in crate::window) struct Overlay {
    pub(in crate::window) primitives: Vec<ClippedPrimitive>,
    pub(in crate::window) pixels_per_point: f32,
}

/// The pipeline for a window of one format, egui's textures, and room for its triangles.
pub(in crate::window) struct Painter {
    pipeline: RenderPipeline,
    screen: Buffer,
    of_screen: BindGroup,
    image_layout: BindGroupLayout,
    sampler: Sampler,
    images: HashMap<TextureId, (Texture, BindGroup)>,
    vertices: Growing,
    indices: Growing,
}

/// A buffer that is made anew where it is too small.
struct Growing {
    buffer: Buffer,
    usage: BufferUsages,
}

impl Growing {
    fn new(gpu: &Gpu, usage: BufferUsages, size: u64) -> Self {
        let usage = usage | BufferUsages::COPY_DST;
        let descriptor = BufferDescriptor { label: Some("overlay"), size, usage, mapped_at_creation: false };
        Self { buffer: gpu.device().create_buffer(&descriptor), usage }
    }

    fn fill(&mut self, gpu: &Gpu, bytes: &[u8]) {
        if bytes.len() as u64 > self.buffer.size() {
            *self = Self::new(gpu, self.usage, (bytes.len() as u64).next_power_of_two());
        }
        gpu.queue().write_buffer(&self.buffer, 0, bytes);
    }
}

impl Painter {
    pub(in crate::window) fn new(gpu: &Gpu, format: TextureFormat) -> Self {
        let device = gpu.device();
        let group = |entries: &[(ShaderStages, BindingType)]| {
            let entry = |((visibility, ty), binding): (&(ShaderStages, BindingType), u32)| BindGroupLayoutEntry {
                binding,
                visibility: *visibility,
                ty: *ty,
                count: None,
            };
            let entries: Vec<_> = entries.iter().zip(0..).map(entry).collect();
            device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some("overlay"), entries: &entries })
        };
        let uniform =
            BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None };
        let image = BindingType::Texture {
            sample_type: TextureSampleType::Float { filterable: true },
            view_dimension: TextureViewDimension::D2,
            multisampled: false,
        };
        let screen_layout = group(&[(ShaderStages::VERTEX, uniform)]);
        let image_layout = group(&[
            (ShaderStages::FRAGMENT, image),
            (ShaderStages::FRAGMENT, BindingType::Sampler(SamplerBindingType::Filtering)),
        ]);
        let screen = device.create_buffer(&BufferDescriptor {
            label: Some("overlay"),
            size: size_of::<[f32; 4]>() as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let of_screen = device.create_bind_group(&BindGroupDescriptor {
            label: Some("overlay"),
            layout: &screen_layout,
            entries: &[BindGroupEntry { binding: 0, resource: screen.as_entire_binding() }],
        });
        let sampler = device.create_sampler(&SamplerDescriptor {
            label: Some("overlay"),
            address_mode_u: AddressMode::ClampToEdge,
            address_mode_v: AddressMode::ClampToEdge,
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            ..Default::default()
        });
        Self {
            pipeline: pipeline(gpu, format, &[Some(&screen_layout), Some(&image_layout)]),
            screen,
            of_screen,
            image_layout,
            sampler,
            images: HashMap::new(),
            vertices: Growing::new(gpu, BufferUsages::VERTEX, 1 << 16),
            indices: Growing::new(gpu, BufferUsages::INDEX, 1 << 16),
        }
    }

    /// Takes over textures that are new or have changed.
    pub(in crate::window) fn receive(&mut self, gpu: &Gpu, textures: &TexturesDelta) {
        for (id, delta) in &textures.set {
            self.set(gpu, *id, delta);
        }
    }

    /// Forgets textures, after the last frame with them was painted.
    pub(in crate::window) fn forget(&mut self, textures: &TexturesDelta) {
        for id in &textures.free {
            self.images.remove(id);
        }
    }

    #[allow(clippy::cast_possible_truncation, reason = "egui keeps to the largest side it was told")]
    fn set(&mut self, gpu: &Gpu, id: TextureId, delta: &ImageDelta) {
        let ImageData::Color(image) = &delta.image;
        let [width, height] = image.size.map(|side| side as u32);
        let extent = Extent3d { width, height, depth_or_array_layers: 1 };
        let origin = match delta.pos {
            Some([x, y]) => Origin3d { x: x as u32, y: y as u32, z: 0 },
            None => {
                self.images.insert(id, self.image(gpu, extent));
                Origin3d::ZERO
            }
        };
        let Some((texture, _)) = self.images.get(&id) else {
            return;
        };
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
        let to = TexelCopyTextureInfo { origin, ..texture.as_image_copy() };
        gpu.queue().write_texture(to, bytemuck::cast_slice(&image.pixels), layout, extent);
    }

    fn image(&self, gpu: &Gpu, size: Extent3d) -> (Texture, BindGroup) {
        let texture = gpu.device().create_texture(&TextureDescriptor {
            label: Some("overlay"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: TextureFormat::Rgba8Unorm,
            usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let view = texture.create_view(&TextureViewDescriptor::default());
        let group = gpu.device().create_bind_group(&BindGroupDescriptor {
            label: Some("overlay"),
            layout: &self.image_layout,
            entries: &[
                BindGroupEntry { binding: 0, resource: BindingResource::TextureView(&view) },
                BindGroupEntry { binding: 1, resource: BindingResource::Sampler(&self.sampler) },
            ],
        });
        (texture, group)
    }

    /// Paints over a target of `size` pixels.
    pub(in crate::window) fn record(
        &mut self,
        gpu: &Gpu,
        pass: &mut RenderPass<'_>,
        overlay: &Overlay,
        size: [u32; 2],
    ) {
        let (mut vertices, mut indices) = (Vec::<Vertex>::new(), Vec::<u32>::new());
        let mut ranges = Vec::new();
        for ClippedPrimitive { clip_rect, primitive } in &overlay.primitives {
            let Primitive::Mesh(mesh) = primitive else {
                continue;
            };
            // GLES 3.0 adds nothing to indices.
            let (base, from) = (index_of(vertices.len()), index_of(indices.len()));
            vertices.extend(&mesh.vertices);
            indices.extend(mesh.indices.iter().map(|index| base + index));
            ranges.push((*clip_rect, mesh.texture_id, from..index_of(indices.len())));
        }
        self.vertices.fill(gpu, bytemuck::cast_slice(&vertices));
        self.indices.fill(gpu, bytemuck::cast_slice(&indices));
        #[allow(clippy::cast_precision_loss, reason = "windows are a few thousand pixels wide")]
        let [width, height] = size.map(|side| side as f32 / overlay.pixels_per_point);
        gpu.queue().write_buffer(&self.screen, 0, bytemuck::bytes_of(&[width, height, 0.0, 0.0]));

        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.of_screen, &[]);
        pass.set_vertex_buffer(0, self.vertices.buffer.slice(..));
        pass.set_index_buffer(self.indices.buffer.slice(..), IndexFormat::Uint32);
        for (clip, id, range) in ranges {
            let ([x, y, width, height], Some((_, image))) =
                (scissors(clip, overlay.pixels_per_point, size), self.images.get(&id))
            else {
                continue;
            };
            if width > 0 && height > 0 {
                pass.set_scissor_rect(x, y, width, height);
                pass.set_bind_group(1, image, &[]);
                pass.draw_indexed(range, 0, 0..1);
            }
        }
    }
}

fn index_of(len: usize) -> u32 {
    u32::try_from(len).unwrap_or(u32::MAX)
}

/// Left, top, width and height in pixels of the part of a rectangle, given in points, that lies in a picture of `size`.
fn scissors(clip: Rect, pixels_per_point: f32, size: [u32; 2]) -> [u32; 4] {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is clamped")]
    let pixel = |points: f32, side: u32| ((pixels_per_point * points).round() as u32).min(side);
    let [left, right] = [clip.min.x, clip.max.x].map(|x| pixel(x, size[0]));
    let [top, bottom] = [clip.min.y, clip.max.y].map(|y| pixel(y, size[1]));
    [left, top, right.saturating_sub(left), bottom.saturating_sub(top)]
}

fn pipeline(gpu: &Gpu, format: TextureFormat, groups: &[Option<&BindGroupLayout>]) -> RenderPipeline {
    let device = gpu.device();
    let module = device.create_shader_module(ShaderModuleDescriptor {
        label: Some("overlay"),
        source: ShaderSource::Wgsl(include_str!("overlay.wgsl").into()),
    });
    let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: Some("overlay"),
        bind_group_layouts: groups,
        immediate_size: 0,
    });
    // Premultiplied.
    let over = |src_factor, dst_factor| BlendComponent { src_factor, dst_factor, operation: BlendOperation::Add };
    let blend = BlendState {
        color: over(BlendFactor::One, BlendFactor::OneMinusSrcAlpha),
        alpha: over(BlendFactor::OneMinusDstAlpha, BlendFactor::One),
    };
    let constants = [("encodes", f64::from(u8::from(format.is_srgb())))];
    let attributes = vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Unorm8x4];
    device.create_render_pipeline(&RenderPipelineDescriptor {
        label: Some("overlay"),
        layout: Some(&layout),
        vertex: VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: PipelineCompilationOptions::default(),
            buffers: &[Some(VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: VertexStepMode::Vertex,
                attributes: &attributes,
            })],
        },
        primitive: PrimitiveState::default(),
        depth_stencil: None,
        multisample: MultisampleState::default(),
        fragment: Some(FragmentState {
            module: &module,
            entry_point: Some("mixed"),
            compilation_options: PipelineCompilationOptions { constants: &constants, ..Default::default() },
            targets: &[Some(ColorTargetState { format, blend: Some(blend), write_mask: ColorWrites::ALL })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scissors_stay_in_the_picture() {
        let rect = |x0: f32, y0: f32, x1: f32, y1: f32| Rect { min: [x0, y0].into(), max: [x1, y1].into() };
        assert_eq!(scissors(rect(1.0, 2.0, 5.0, 7.0), 2.0, [100, 100]), [2, 4, 8, 10]);
        assert_eq!(scissors(rect(-5.0, -5.0, 500.0, 50.0), 1.0, [100, 80]), [0, 0, 100, 50]);
        assert_eq!(scissors(rect(200.0, 0.0, 300.0, 50.0), 1.0, [100, 80])[2], 0);
        assert_eq!(scissors(Rect::EVERYTHING, 1.5, [100, 80]), [0, 0, 100, 80]);
        assert_eq!(scissors(Rect::NOTHING, 1.5, [100, 80])[2..], [0, 0]);
    }
}
