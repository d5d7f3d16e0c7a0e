//! Render pipelines: a shader compiled for its targets, its bind groups, and the beginning of a pass.

use subsurf_shaders::passes::{Binding, Variant};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindingResource,
    BlendState, Color, ColorTargetState, ColorWrites, CommandEncoder, DepthStencilState, FragmentState, LoadOp,
    MultisampleState, Operations, PipelineCompilationOptions, PipelineLayoutDescriptor, PrimitiveState,
    PrimitiveTopology, RenderPass, RenderPassColorAttachment, RenderPassDepthStencilAttachment, RenderPassDescriptor,
    RenderPipelineDescriptor, ShaderModuleDescriptor, ShaderSource, StoreOp, TextureFormat, TextureView,
    VertexBufferLayout, VertexState,
};

use super::cache::Pipeline;
use super::device::Gpu;
use super::layout::layout_entries;
use crate::error::Result;

/// Shader of a pipeline, what it reads and what it draws to.
pub(crate) struct Program<'a> {
    /// Pass, with what it leaves open chosen.
    pub(crate) variant: Variant,
    /// Values of overrides; those that the pass does not have are left out.
    pub(crate) constants: &'a [(&'a str, bool)],
    /// Formats of the colour targets.
    pub(crate) targets: &'a [TextureFormat],
}

/// Fixed state of a pipeline: from vertices to samples of the targets.
#[derive(Default)]
pub(crate) struct Drawing<'a> {
    pub(crate) topology: PrimitiveTopology,
    /// How values are added to those of the target; replaced if `None`.
    pub(crate) blend: Option<BlendState>,
    pub(crate) vertices: &'a [VertexBufferLayout<'a>],
    pub(crate) depth: Option<DepthStencilState>,
    pub(crate) multisample: MultisampleState,
}

impl Pipeline {
    /// Compiles a shader.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the driver refuses it.
    pub(crate) fn new(gpu: &Gpu, program: &Program<'_>, drawing: Drawing<'_>) -> Result<Self> {
        let pass = program.variant.pass;
        let label = Some(pass.name());
        gpu.checked(|| {
            let groups = program.variant.groups();
            let groups: Vec<BindGroupLayout> = groups.iter().map(|bindings| bind_group_layout(gpu, bindings)).collect();
            let module = gpu.device.create_shader_module(ShaderModuleDescriptor {
                label,
                source: ShaderSource::Wgsl(program.variant.wgsl(gpu.target_format()).into()),
            });
            let bind_group_layouts: Vec<Option<&BindGroupLayout>> = groups.iter().map(Some).collect();
            let target = |format: &TextureFormat| {
                Some(ColorTargetState { format: *format, blend: drawing.blend, write_mask: ColorWrites::ALL })
            };
            let targets: Vec<Option<ColorTargetState>> = program.targets.iter().map(target).collect();
            let layout = gpu.device.create_pipeline_layout(&PipelineLayoutDescriptor {
                label,
                bind_group_layouts: &bind_group_layouts,
                immediate_size: 0,
            });
            let is_known = |(name, _): &&(&str, bool)| pass.overrides.contains(name);
            let constants = program.constants.iter().filter(is_known);
            let constants: Vec<(&str, f64)> = constants.map(|(name, value)| (*name, f64::from(*value))).collect();
            let compilation_options = PipelineCompilationOptions { constants: &constants, ..Default::default() };
            let vertices: Vec<_> = drawing.vertices.iter().cloned().map(Some).collect();
            let pipeline = gpu.device.create_render_pipeline(&RenderPipelineDescriptor {
                label,
                layout: Some(&layout),
                vertex: VertexState {
                    module: &module,
                    entry_point: Some(pass.vertex),
                    compilation_options: compilation_options.clone(),
                    buffers: &vertices,
                },
                primitive: PrimitiveState { topology: drawing.topology, ..Default::default() },
                depth_stencil: drawing.depth,
                multisample: drawing.multisample,
                fragment: Some(FragmentState {
                    module: &module,
                    entry_point: label,
                    compilation_options: compilation_options.clone(),
                    targets: &targets,
                }),
                multiview_mask: None,
                cache: None,
            });
            Self { name: pass.name(), pipeline, groups }
        })
    }

    /// Binds resources, in order, to bind group number `group`.
    pub(crate) fn bind(&self, gpu: &Gpu, group: usize, resources: &[BindingResource<'_>]) -> Result<BindGroup> {
        bind(gpu, &self.groups[group], resources)
    }

    /// Begins a pass that draws to `attachments`, with `groups` bound from 0 on.
    pub(crate) fn begin<'e>(
        &self,
        encoder: &'e mut CommandEncoder,
        attachments: &[Option<RenderPassColorAttachment<'_>>],
        depth: Option<(&TextureView, Operations<f32>)>,
        groups: &[&BindGroup],
    ) -> RenderPass<'e> {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: None,
            color_attachments: attachments,
            depth_stencil_attachment: depth.map(|(view, operations)| RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(operations),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&self.pipeline);
        for (group, index) in groups.iter().zip(0..) {
            pass.set_bind_group(index, *group, &[]);
        }
        pass
    }
}

/// Attachment of a colour target whose values are stored.
pub(crate) fn attachment<'a>(view: &'a TextureView, load: LoadOp<Color>) -> RenderPassColorAttachment<'a> {
    RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: Operations { load, store: StoreOp::Store },
    }
}

/// Binds resources, in order.
pub(crate) fn bind(gpu: &Gpu, layout: &BindGroupLayout, resources: &[BindingResource<'_>]) -> Result<BindGroup> {
    let entries = resources.iter().zip(0..);
    let entries: Vec<BindGroupEntry<'_>> =
        entries.map(|(resource, binding)| BindGroupEntry { binding, resource: resource.clone() }).collect();
    gpu.checked(|| gpu.device.create_bind_group(&BindGroupDescriptor { label: None, layout, entries: &entries }))
}

/// Layout of a bind group; those of equal bindings fit each other.
pub(crate) fn bind_group_layout(gpu: &Gpu, bindings: &[Binding]) -> BindGroupLayout {
    let entries = layout_entries(bindings, gpu.target_format());
    gpu.device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: None, entries: &entries })
}
