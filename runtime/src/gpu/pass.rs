//! Passes without a mesh: one triangle over the whole target, or quads that are added up.

use std::sync::Arc;

use subsurf_shaders::passes::Variant;
use wgpu::{
    BindGroup, BindingResource, BlendComponent, BlendFactor, BlendOperation, BlendState, Color, CommandEncoder,
    CommandEncoderDescriptor, LoadOp, PrimitiveTopology, TextureFormat, TextureView,
};

use super::cache::Pipeline;
use super::device::Gpu;
use super::pipeline::{Drawing, Program, attachment};
use crate::error::Result;

/// Pass that covers its whole target with one triangle; passes of one variant and targets share a pipeline.
#[derive(Clone, Debug)]
pub(crate) struct FullscreenPass(Arc<Pipeline>);

impl FullscreenPass {
    /// Compiles a variant of a full-screen pass for targets of these formats, unless it is.
    pub(crate) fn new(gpu: &Gpu, variant: Variant, targets: &[TextureFormat]) -> Result<Self> {
        let program = Program { variant, constants: &[], targets };
        let compile = || Pipeline::new(gpu, &program, Drawing::default());
        Ok(Self(gpu.fullscreen.get_or(variant.name(), targets, compile)?))
    }

    /// Name of the pass.
    pub(crate) fn name(&self) -> &'static str {
        self.0.name
    }

    /// Binds resources, in order, to bind group number `group`.
    pub(crate) fn bind(&self, gpu: &Gpu, group: usize, resources: &[BindingResource<'_>]) -> Result<BindGroup> {
        self.0.bind(gpu, group, resources)
    }

    /// Draws `rows` rows of the targets from `first` on.
    pub(crate) fn record(
        &self,
        encoder: &mut CommandEncoder,
        targets: &[&TextureView],
        groups: &[&BindGroup],
        rows: Rows,
    ) {
        self.record_for(encoder, targets, groups, None, rows);
    }

    /// The same with the block of an object at an offset, in bind group 2.
    fn record_for(
        &self,
        encoder: &mut CommandEncoder,
        targets: &[&TextureView],
        groups: &[&BindGroup],
        object: Option<(&BindGroup, u32)>,
        rows: Rows,
    ) {
        // What stood there before is only wanted by bands after the first: loading it costs a tiler dearly.
        let load = if rows.first == 0 { LoadOp::Clear(Color::TRANSPARENT) } else { LoadOp::Load };
        let attachments: Vec<_> = targets.iter().map(|view| Some(attachment(view, load))).collect();
        let mut pass = self.0.begin(encoder, &attachments, None, groups);
        if let Some((blocks, offset)) = object {
            pass.set_bind_group(2, blocks, &[offset]);
        }
        pass.set_scissor_rect(0, rows.first, rows.width, rows.count);
        pass.draw(0..3, 0..1);
    }

    /// Draws `rows` rows of one target, in a submission of its own.
    pub(crate) fn draw(&self, gpu: &Gpu, target: &TextureView, groups: &[&BindGroup], rows: Rows) -> Result<()> {
        self.draw_for(gpu, target, groups, None, rows)
    }

    /// The same with the block of an object at an offset, in bind group 2.
    pub(crate) fn draw_for(
        &self,
        gpu: &Gpu,
        target: &TextureView,
        groups: &[&BindGroup],
        object: Option<(&BindGroup, u32)>,
        rows: Rows,
    ) -> Result<()> {
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            self.record_for(&mut encoder, &[target], groups, object, rows);
            gpu.queue.submit([encoder.finish()]);
        })
    }
}

/// Pass that adds instances of a square to its target.
#[derive(Debug)]
pub(crate) struct QuadPass(Pipeline);

impl QuadPass {
    /// Compiles a variant of a pass whose vertices are corners of a quad.
    pub(crate) fn new(gpu: &Gpu, variant: Variant, target: TextureFormat) -> Result<Self> {
        let add = BlendComponent {
            src_factor: BlendFactor::One,
            dst_factor: BlendFactor::One,
            operation: BlendOperation::Add,
        };
        let blend = Some(BlendState { color: add, alpha: add });
        let program = Program { variant, constants: &[], targets: &[target] };
        let drawing = Drawing { topology: PrimitiveTopology::TriangleStrip, blend, ..Default::default() };
        Ok(Self(Pipeline::new(gpu, &program, drawing)?))
    }

    /// Name of the pass.
    pub(crate) fn name(&self) -> &'static str {
        self.0.name
    }

    /// Binds resources, in order, to bind group number `group`.
    pub(crate) fn bind(&self, gpu: &Gpu, group: usize, resources: &[BindingResource<'_>]) -> Result<BindGroup> {
        self.0.bind(gpu, group, resources)
    }

    /// Adds quads to a target that is cleared to 0; of each draw, bind group 1 and the number of quads.
    pub(crate) fn record(
        &self,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        group: &BindGroup,
        draws: &[(&BindGroup, u32)],
    ) {
        let attachments = [Some(attachment(target, LoadOp::Clear(Color::TRANSPARENT)))];
        let mut pass = self.0.begin(encoder, &attachments, None, &[group]);
        for (of_draw, quads) in draws {
            pass.set_bind_group(1, *of_draw, &[]);
            pass.draw(0..4, 0..*quads);
        }
    }
}

/// Band of rows of a target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows {
    /// Texels of a row.
    pub(crate) width: u32,
    /// Number of the first row, from the top.
    pub(crate) first: u32,
    /// Number of rows.
    pub(crate) count: u32,
}

impl Rows {
    /// All rows of a target of `size`, width and height.
    pub(crate) fn all(size: [u32; 2]) -> Self {
        Self { width: size[0], first: 0, count: size[1] }
    }

    /// All rows of a target of `size`, in bands of at most `work_per_row` · rows ≈ 2²⁸ steps of a loop each: one submission
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
