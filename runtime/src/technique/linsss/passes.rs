//! Pipelines of LinSSS.

use subsurf_shaders::passes::linsss;

use crate::error::Result;
use crate::frame::RuntimeOptions;
use crate::gpu::{FullscreenPass, Gpu};
use crate::technique::mesh_pass::{DepthFormat, MeshPass};

/// Pipelines, for any number of Gaussians.
#[derive(Debug)]
pub(crate) struct Passes {
    pub(super) depth: DepthFormat,
    pub(super) gbuffer: MeshPass,
    pub(super) blur: FullscreenPass,
    pub(super) reduce: FullscreenPass,
    pub(super) lookup: FullscreenPass,
    pub(super) shade: MeshPass,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, options: &RuntimeOptions) -> Result<Self> {
        let map = gpu.target_texture_format();
        Ok(Self {
            depth: options.depth,
            gbuffer: MeshPass::lit(gpu, linsss::LINSSS_GBUFFER.only(), &[map; 3], options)?,
            blur: FullscreenPass::new(gpu, linsss::LINSSS_BLUR.only(), &[map; 2])?,
            reduce: FullscreenPass::new(gpu, linsss::LINSSS_REDUCE.only(), &[map])?,
            lookup: FullscreenPass::new(gpu, linsss::LINSSS_LOOKUP.only(), &[map])?,
            shade: MeshPass::picture(gpu, linsss::SHADE_LINSSS.only(), options)?,
        })
    }
}
