//! Pipelines of splats.

use subsurf_shaders::MaterialLayout;
use subsurf_shaders::passes::{Choice, table};
use wgpu::TextureFormat;

use crate::error::Result;
use crate::gpu::{FullscreenPass, Gpu, HALF, QuadPass};
use crate::technique::mesh_pass::MeshPass;

/// Pipelines for materials of one layout.
#[derive(Debug)]
pub(crate) struct Passes {
    pub(super) layout: MaterialLayout,
    pub(super) gbuffer: MeshPass,
    pub(super) tsm_reduce: FullscreenPass,
    pub(super) splat: QuadPass,
    pub(super) resolve: FullscreenPass,
    pub(super) shade: MeshPass,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, layout: MaterialLayout, format: TextureFormat, samples: u32) -> Result<Self> {
        gpu.expect_half_targets("splats")?;
        Ok(Self {
            layout,
            gbuffer: MeshPass::new(gpu, table::SURFACE_GBUFFER.only(), &[HALF; 3])?,
            tsm_reduce: FullscreenPass::new(gpu, table::TSM_REDUCE.only(), &[HALF; 3])?,
            splat: QuadPass::new(gpu, table::SPLAT.with(Choice::Material(layout)), HALF)?,
            resolve: FullscreenPass::new(gpu, table::SPLAT_RESOLVE.only(), &[HALF])?,
            shade: MeshPass::picture(gpu, table::SHADE_SPLAT.only(), format, samples)?,
        })
    }
}
