//! Pipelines: one shader, its bind groups, one target.

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindingResource,
    BlendComponent, BlendFactor, BlendOperation, BlendState, Color, ColorTargetState, ColorWrites, CommandEncoder,
    CommandEncoderDescriptor, FragmentState, LoadOp, MultisampleState, Operations, PipelineLayoutDescriptor,
    PrimitiveState, PrimitiveTopology, RenderPassColorAttachment, RenderPassDescriptor, RenderPipeline,
    RenderPipelineDescriptor, ShaderModuleDescriptor, ShaderSource, StoreOp, TextureFormat, TextureView, VertexState,
};

use crate::context::Gpu;
use crate::error::Result;
use crate::resource::{Slot, layout_entries};

/// A pass that covers its whole target with one triangle.
#[derive(Debug)]
pub(crate) struct CoverPass {
    pipeline: RenderPipeline,
    groups: Vec<BindGroupLayout>,
}

/// How a pass without a mesh draws.
struct Drawing<'a> {
    vertex: &'a str,
    topology: PrimitiveTopology,
    /// What is done with what stands there already.
    blend: Option<BlendState>,
}

impl CoverPass {
    /// Builds the pipeline of a shader with the entry points `cover` and `fragment`, bind groups of these slots, and
    /// targets of these formats.
    pub(crate) fn new(
        gpu: &Gpu,
        shader: &str,
        fragment: &str,
        groups: &[&[Slot]],
        targets: &[TextureFormat],
    ) -> Result<Self> {
        let drawing = Drawing { vertex: "cover", topology: PrimitiveTopology::TriangleList, blend: None };
        Self::build(gpu, shader, fragment, groups, targets, &drawing)
    }

    /// The same for a shader with the entry points `spread` and `fragment`, which draws instances of a square and adds to
    /// what stands there.
    pub(crate) fn adding_squares(
        gpu: &Gpu,
        shader: &str,
        fragment: &str,
        groups: &[&[Slot]],
        targets: &[TextureFormat],
    ) -> Result<Self> {
        let add = BlendComponent {
            src_factor: BlendFactor::One,
            dst_factor: BlendFactor::One,
            operation: BlendOperation::Add,
        };
        let blend = Some(BlendState { color: add, alpha: add });
        let drawing = Drawing { vertex: "spread", topology: PrimitiveTopology::TriangleStrip, blend };
        Self::build(gpu, shader, fragment, groups, targets, &drawing)
    }

    fn build(
        gpu: &Gpu,
        shader: &str,
        fragment: &str,
        groups: &[&[Slot]],
        targets: &[TextureFormat],
        drawing: &Drawing<'_>,
    ) -> Result<Self> {
        gpu.checked(|| {
            let groups = bind_group_layouts(gpu, groups);
            let module = gpu.device.create_shader_module(ShaderModuleDescriptor {
                label: Some(fragment),
                source: ShaderSource::Wgsl(shader.into()),
            });
            let bind_group_layouts: Vec<Option<&BindGroupLayout>> = groups.iter().map(Some).collect();
            let target = |format: &TextureFormat| {
                Some(ColorTargetState { format: *format, blend: drawing.blend, write_mask: ColorWrites::ALL })
            };
            let targets: Vec<Option<ColorTargetState>> = targets.iter().map(target).collect();
            let layout = gpu.device.create_pipeline_layout(&PipelineLayoutDescriptor {
                label: Some(fragment),
                bind_group_layouts: &bind_group_layouts,
                immediate_size: 0,
            });
            let pipeline = gpu.device.create_render_pipeline(&RenderPipelineDescriptor {
                label: Some(fragment),
                layout: Some(&layout),
                vertex: VertexState {
                    module: &module,
                    entry_point: Some(drawing.vertex),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: PrimitiveState { topology: drawing.topology, ..Default::default() },
                depth_stencil: None,
                multisample: MultisampleState::default(),
                fragment: Some(FragmentState {
                    module: &module,
                    entry_point: Some(fragment),
                    compilation_options: Default::default(),
                    targets: &targets,
                }),
                multiview_mask: None,
                cache: None,
            });
            Self { pipeline, groups }
        })
    }

    /// Binds resources, in order, to bind group number `group`.
    pub(crate) fn bind(&self, gpu: &Gpu, group: usize, resources: &[BindingResource<'_>]) -> Result<BindGroup> {
        bind(gpu, &self.groups[group], resources)
    }

    /// Draws `rows` rows of the targets from `first` on.
    pub(crate) fn record(
        &self,
        encoder: &mut CommandEncoder,
        targets: &[&TextureView],
        groups: &[&BindGroup],
        rows: Rows,
    ) {
        // What stood there before is only wanted by bands after the first: loading it costs a tiler dearly.
        let load = if rows.first == 0 { LoadOp::Clear(Color::TRANSPARENT) } else { LoadOp::Load };
        let attachments: Vec<_> = targets.iter().map(|view| Some(attachment(view, load))).collect();
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: None,
            color_attachments: &attachments,
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&self.pipeline);
        for (group, index) in groups.iter().zip(0..) {
            pass.set_bind_group(index, *group, &[]);
        }
        pass.set_scissor_rect(0, rows.first, rows.width, rows.count);
        pass.draw(0..3, 0..1);
    }

    /// Adds squares to a target that begins black: bind group 1 of each draw, and how many squares it has.
    pub(crate) fn record_squares(
        &self,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        group: &BindGroup,
        draws: &[(&BindGroup, u32)],
    ) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: None,
            color_attachments: &[Some(attachment(target, LoadOp::Clear(Color::TRANSPARENT)))],
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        for (of_draw, squares) in draws {
            pass.set_bind_group(1, *of_draw, &[]);
            pass.draw(0..4, 0..*squares);
        }
    }

    /// The same on one target, handed to the device.
    pub(crate) fn draw(&self, gpu: &Gpu, target: &TextureView, groups: &[&BindGroup], rows: Rows) -> Result<()> {
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            self.record(&mut encoder, &[target], groups, rows);
            gpu.queue.submit([encoder.finish()]);
        })
    }
}

/// A colour target that is kept.
pub(crate) fn attachment<'a>(view: &'a TextureView, load: LoadOp<Color>) -> RenderPassColorAttachment<'a> {
    RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: Operations { load, store: StoreOp::Store },
    }
}

/// Rows of a target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows {
    pub(crate) width: u32,
    pub(crate) first: u32,
    pub(crate) count: u32,
}

impl Rows {
    /// All of a target of `size`.
    pub(crate) fn all(size: [u32; 2]) -> Self {
        Self { width: size[0], first: 0, count: size[1] }
    }

    /// All of a target of `size`, in bands of at most `work_per_row` · rows ≈ 2²⁸ steps of a loop each: one submission
    /// that runs for seconds trips a driver's watchdog.
    pub(crate) fn bands(size: [u32; 2], work_per_row: u64) -> impl Iterator<Item = Self> {
        let rows = ((1_u64 << 28) / work_per_row.max(1)).clamp(1, u64::from(size[1].max(1)));
        let rows = u32::try_from(rows).unwrap_or(1);
        (0..size[1]).step_by(rows as usize).map(move |first| Self {
            width: size[0],
            first,
            count: rows.min(size[1] - first),
        })
    }
}

pub(crate) fn bind_group_layouts(gpu: &Gpu, groups: &[&[Slot]]) -> Vec<BindGroupLayout> {
    let layout = |slots: &&[Slot]| {
        let entries = layout_entries(slots);
        gpu.device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: None, entries: &entries })
    };
    groups.iter().map(layout).collect()
}

pub(crate) fn bind(gpu: &Gpu, layout: &BindGroupLayout, resources: &[BindingResource<'_>]) -> Result<BindGroup> {
    let entries = resources.iter().zip(0..);
    let entries: Vec<BindGroupEntry<'_>> =
        entries.map(|(resource, binding)| BindGroupEntry { binding, resource: resource.clone() }).collect();
    gpu.checked(|| gpu.device.create_bind_group(&BindGroupDescriptor { label: None, layout, entries: &entries }))
}
