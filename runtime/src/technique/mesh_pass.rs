//! Passes that draw meshes.

use subsurf_shaders::passes::Variant;
use subsurf_shaders::passes::table::ENCODE_SRGB;
use wgpu::{
    BindGroup, BindingResource, Color, CommandEncoder, CompareFunction, DepthStencilState, LoadOp, MultisampleState,
    RenderPassColorAttachment, TextureFormat, TextureView, VertexBufferLayout,
};

use crate::asset::{GpuMesh, TANGENTS, VERTICES};
use crate::error::Result;
use crate::gpu::{DEPTH, Drawing, Gpu, Pipeline, Program, attachment};

/// Pass that draws a mesh, with depth.
#[derive(Debug)]
pub(crate) struct MeshPass(Pipeline);

/// Colour target of a pass, and what it is cleared to. With several samples to a texel, `resolved` gets their mean.
pub(crate) struct Target<'a> {
    pub(crate) view: &'a TextureView,
    pub(crate) clear: Color,
    pub(crate) resolved: Option<&'a TextureView>,
}

impl<'a> Target<'a> {
    fn cleared(&self) -> RenderPassColorAttachment<'a> {
        let plain = attachment(self.view, LoadOp::Clear(self.clear));
        RenderPassColorAttachment { resolve_target: self.resolved, ..plain }
    }
}

impl MeshPass {
    /// Compiles a variant of a pass for targets of these formats, of one sample to a texel.
    pub(crate) fn new(gpu: &Gpu, variant: Variant, targets: &[TextureFormat]) -> Result<Self> {
        let program = Program { variant, constants: &[], targets };
        Self::with(gpu, &program, &[VERTICES], 1)
    }

    /// Compiles a variant of a pass that draws a picture of `format`, with so many samples to a pixel.
    pub(crate) fn picture(gpu: &Gpu, variant: Variant, format: TextureFormat, samples: u32) -> Result<Self> {
        let program = Program { variant, constants: &display_constants(format), targets: &[format] };
        Self::with(gpu, &program, &[VERTICES], samples)
    }

    /// The same for a pass that takes tangents; it draws meshes that have them.
    pub(crate) fn textured_picture(gpu: &Gpu, variant: Variant, format: TextureFormat, samples: u32) -> Result<Self> {
        let program = Program { variant, constants: &display_constants(format), targets: &[format] };
        Self::with(gpu, &program, &[VERTICES, TANGENTS], samples)
    }

    fn with(gpu: &Gpu, program: &Program<'_>, vertices: &[VertexBufferLayout<'_>], samples: u32) -> Result<Self> {
        let drawing = Drawing {
            vertices,
            depth: Some(DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(true),
                depth_compare: Some(CompareFunction::Less),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: MultisampleState { count: samples, ..Default::default() },
            ..Default::default()
        };
        Ok(Self(Pipeline::new(gpu, program, drawing)?))
    }

    /// Binds resources, in order, to bind group number `group`.
    pub(crate) fn bind(&self, gpu: &Gpu, group: usize, resources: &[BindingResource<'_>]) -> Result<BindGroup> {
        self.0.bind(gpu, group, resources)
    }

    /// Records the pass.
    pub(crate) fn record(
        &self,
        encoder: &mut CommandEncoder,
        targets: &[Target<'_>],
        depth: &TextureView,
        groups: &[&BindGroup],
        mesh: &GpuMesh,
    ) {
        let attachments: Vec<_> = targets.iter().map(|target| Some(target.cleared())).collect();
        let mut pass = self.0.begin(encoder, &attachments, Some(depth), groups);
        mesh.draw(&mut pass);
    }
}

/// Values of the overrides of a picture: the shader encodes for the display, unless the target does.
fn display_constants(format: TextureFormat) -> [(&'static str, f64); 1] {
    [(ENCODE_SRGB, f64::from(!format.is_srgb()))]
}
