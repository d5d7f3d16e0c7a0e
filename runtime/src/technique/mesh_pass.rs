//! Passes that draw meshes.

use subsurf_shaders::passes::Variant;
use subsurf_shaders::passes::table::{ENCODE_SRGB, HOST_SHADOWS, TONE_MAP};
use wgpu::{
    BindGroup, BindingResource, Color, CommandEncoder, CompareFunction, DepthStencilState, LoadOp, MultisampleState,
    Operations, RenderPass, RenderPassColorAttachment, StoreOp, TextureFormat, TextureView, VertexBufferLayout,
};

use crate::asset::{GpuMesh, TANGENTS, VERTICES};
use crate::error::Result;
use crate::frame::RuntimeOptions;
use crate::gpu::{Drawing, Gpu, Pipeline, Program, attachment};

/// Pass that draws meshes, with depth.
#[derive(Debug)]
pub(crate) struct MeshPass {
    pipeline: Pipeline,
    /// Whether visibilities of lights are looked up.
    has_shadows: bool,
}

/// Bind groups that passes of all materials share.
#[derive(Clone, Copy)]
pub(crate) struct SharedGroups<'a> {
    /// Number 2: blocks of all objects.
    pub(crate) objects: &'a BindGroup,
    /// Number 3, of passes that look up visibilities of lights: the host's shadow maps.
    pub(crate) host_shadows: &'a BindGroup,
}

/// Depth of a pass: its format, and whether what is nearer has the larger value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthFormat {
    /// Format of the texture.
    pub format: TextureFormat,
    /// Whether depth falls from 1 at the near plane to 0 at the far one.
    pub is_reversed: bool,
}

impl DepthFormat {
    /// Value of what is furthest away.
    #[must_use]
    pub fn furthest(&self) -> f32 {
        if self.is_reversed { 0.0 } else { 1.0 }
    }

    /// Operations that begin with what is furthest away, and drop all of it at the end.
    pub(crate) fn own(&self) -> Operations<f32> {
        Operations { load: LoadOp::Clear(self.furthest()), store: StoreOp::Discard }
    }

    fn state(&self) -> DepthStencilState {
        DepthStencilState {
            format: self.format,
            depth_write_enabled: Some(true),
            depth_compare: Some(if self.is_reversed { CompareFunction::Greater } else { CompareFunction::Less }),
            stencil: Default::default(),
            bias: Default::default(),
        }
    }
}

/// Attachments of a pass over meshes.
pub(crate) struct Attachments<'a> {
    pub(crate) colours: &'a [Option<RenderPassColorAttachment<'a>>],
    pub(crate) depth: &'a TextureView,
    pub(crate) depth_ops: Operations<f32>,
    /// Part of the targets that is drawn to; all if `None`.
    pub(crate) viewport: Option<Viewport>,
}

/// Part of targets that a picture is drawn to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Viewport {
    /// Texel of the target where the picture begins; it may lie to the left of it or above.
    pub(crate) origin: [i64; 2],
    /// Width and height of the picture.
    pub(crate) size: [u32; 2],
    /// First texel, width and height of what is drawn of it.
    pub(crate) scissor: [[u32; 2]; 2],
}

impl Viewport {
    /// All of a picture of some size, from a texel on.
    pub(crate) fn at(origin: [u32; 2], size: [u32; 2]) -> Self {
        Self { origin: origin.map(i64::from), size, scissor: [origin, size] }
    }
}

/// Colour target that is cleared.
pub(crate) fn cleared(view: &TextureView, colour: Color) -> Option<RenderPassColorAttachment<'_>> {
    Some(attachment(view, LoadOp::Clear(colour)))
}

/// Mesh of a pass, and the offset of its object's block.
pub(crate) type Draw<'a> = (&'a GpuMesh, u32);

impl MeshPass {
    /// Compiles a variant of a pass for targets of these formats, of one sample to a texel.
    pub(crate) fn new(gpu: &Gpu, variant: Variant, targets: &[TextureFormat], depth: DepthFormat) -> Result<Self> {
        Self::with(gpu, &Program { variant, constants: &[], targets }, &[VERTICES], depth, 1)
    }

    /// The same of a pass that looks up visibilities of lights, with depth as that of the picture.
    pub(crate) fn lit(
        gpu: &Gpu,
        variant: Variant,
        targets: &[TextureFormat],
        options: &RuntimeOptions,
    ) -> Result<Self> {
        let constants = [(HOST_SHADOWS, options.host_shadow_maps)];
        Self::with(gpu, &Program { variant, constants: &constants, targets }, &[VERTICES], options.depth, 1)
    }

    /// Compiles a variant of a pass that draws pictures.
    pub(crate) fn picture(gpu: &Gpu, variant: Variant, options: &RuntimeOptions) -> Result<Self> {
        Self::picture_of(gpu, variant, options, &[VERTICES])
    }

    /// The same for a pass that takes tangents; it draws meshes that have them.
    pub(crate) fn textured_picture(gpu: &Gpu, variant: Variant, options: &RuntimeOptions) -> Result<Self> {
        Self::picture_of(gpu, variant, options, &[VERTICES, TANGENTS])
    }

    fn picture_of(
        gpu: &Gpu,
        variant: Variant,
        options: &RuntimeOptions,
        vertices: &[VertexBufferLayout<'_>],
    ) -> Result<Self> {
        let RuntimeOptions { format, samples, depth, tone_mapping, .. } = *options;
        // Linear light that is not tone-mapped stays linear.
        let encodes = tone_mapping && !format.is_srgb();
        let constants = [(TONE_MAP, tone_mapping), (ENCODE_SRGB, encodes), (HOST_SHADOWS, options.host_shadow_maps)];
        let program = Program { variant, constants: &constants, targets: &[format] };
        Self::with(gpu, &program, vertices, depth, samples)
    }

    fn with(
        gpu: &Gpu,
        program: &Program<'_>,
        vertices: &[VertexBufferLayout<'_>],
        depth: DepthFormat,
        samples: u32,
    ) -> Result<Self> {
        let multisample = MultisampleState { count: samples, ..Default::default() };
        let drawing = Drawing { vertices, depth: Some(depth.state()), multisample, ..Default::default() };
        let has_shadows = program.variant.groups().len() > 3;
        Ok(Self { pipeline: Pipeline::new(gpu, program, drawing)?, has_shadows })
    }

    /// Name of the pass.
    pub(crate) fn name(&self) -> &'static str {
        self.pipeline.name
    }

    /// Binds resources, in order, to bind group number `group`.
    pub(crate) fn bind(&self, gpu: &Gpu, group: usize, resources: &[BindingResource<'_>]) -> Result<BindGroup> {
        self.pipeline.bind(gpu, group, resources)
    }

    /// Records the pass with its bind groups 0 and 1.
    pub(crate) fn record<'m>(
        &self,
        encoder: &mut CommandEncoder,
        attachments: &Attachments<'_>,
        [first, second]: [&BindGroup; 2],
        shared: SharedGroups<'_>,
        draws: impl Iterator<Item = Draw<'m>>,
    ) {
        let depth = Some((attachments.depth, attachments.depth_ops));
        let mut pass = self.pipeline.begin(encoder, attachments.colours, depth, &[first, second]);
        if self.has_shadows {
            pass.set_bind_group(3, shared.host_shadows, &[]);
        }
        if let Some(viewport) = attachments.viewport {
            restrict(&mut pass, viewport);
        }
        draw_all(&mut pass, shared.objects, draws);
    }

    /// Records the pass with the same objects in several parts of its targets, each with a bind group 1 of its own.
    pub(crate) fn record_parts<'m, 'g, I: Iterator<Item = Draw<'m>>>(
        &self,
        encoder: &mut CommandEncoder,
        attachments: &Attachments<'_>,
        first: &BindGroup,
        parts: impl Iterator<Item = (&'g BindGroup, Viewport)>,
        objects: &BindGroup,
        draws: impl Fn() -> I,
    ) {
        let depth = Some((attachments.depth, attachments.depth_ops));
        let mut pass = self.pipeline.begin(encoder, attachments.colours, depth, &[first]);
        for (second, viewport) in parts {
            pass.set_bind_group(1, second, &[]);
            restrict(&mut pass, viewport);
            draw_all(&mut pass, objects, draws());
        }
    }
}

/// Restricts a pass to a part of its targets.
fn restrict(pass: &mut RenderPass<'_>, viewport: Viewport) {
    let Viewport { origin: [x, y], size: [width, height], scissor } = viewport;
    #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
    pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
    let [[x, y], [width, height]] = scissor;
    pass.set_scissor_rect(x, y, width, height);
}

/// Draws meshes with the blocks of their objects.
fn draw_all<'m>(pass: &mut RenderPass<'_>, objects: &BindGroup, draws: impl Iterator<Item = Draw<'m>>) {
    for (mesh, offset) in draws {
        pass.set_bind_group(2, objects, &[offset]);
        mesh.draw(pass);
    }
}
