//! Pipelines of splats.

use subsurf_shaders::MaterialLayout;
use subsurf_shaders::passes::{Choice, table};

use crate::error::Result;
use crate::frame::RuntimeOptions;
use crate::gpu::{FullscreenPass, Gpu, HALF, QuadPass};
use crate::technique::mesh_pass::{DepthFormat, MeshPass};

/// Pipelines for materials of one layout.
#[derive(Debug)]
pub(crate) struct Passes {
    pub(super) depth: DepthFormat,
    pub(super) gbuffer: MeshPass,
    pub(super) tsm_reduce: FullscreenPass,
    pub(super) splat: QuadPass,
    pub(super) resolve: FullscreenPass,
    pub(super) shade: MeshPass,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, layout: MaterialLayout, options: &RuntimeOptions) -> Result<Self> {
        gpu.expect_half_targets("splats")?;
        Ok(Self {
            depth: options.depth,
            gbuffer: MeshPass::new(gpu, table::SURFACE_GBUFFER.only(), &[HALF; 3], options.depth)?,
            tsm_reduce: FullscreenPass::new(gpu, table::TSM_REDUCE.only(), &[HALF; 3])?,
            splat: QuadPass::new(gpu, table::SPLAT.with(Choice::Material(layout)), HALF)?,
            resolve: FullscreenPass::new(gpu, table::SPLAT_RESOLVE.only(), &[HALF])?,
            shade: MeshPass::picture(gpu, table::SHADE_SPLAT.only(), options)?,
        })
    }
}
