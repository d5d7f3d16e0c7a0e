//! Pipelines of light volumes.

use subsurf_shaders::passes::{Choice, Pass, volume};

use crate::error::Result;
use crate::gpu::{FullscreenPass, Gpu};

/// Pipelines for L terms.
#[derive(Debug)]
pub(crate) struct Passes {
    pub(super) fill: FullscreenPass,
    pub(super) blur: FullscreenPass,
    pub(super) sum: FullscreenPass,
}

impl Passes {
    /// Compiles the passes.
    pub(crate) fn new(gpu: &Gpu, terms: usize) -> Result<Self> {
        let targets = vec![gpu.target_texture_format(); terms];
        let pass = |pass: &'static Pass| FullscreenPass::new(gpu, pass.with(Choice::Terms(terms)), &targets);
        Ok(Self {
            fill: pass(&volume::FILL_VOLUME)?,
            blur: pass(&volume::BLUR_VOLUME)?,
            sum: pass(&volume::SUM_VOLUME)?,
        })
    }
}
