//! Pipelines and maps of light volumes.

use subsurf_shaders::passes::{Choice, Pass, volume};

use crate::error::Result;
use crate::gpu::{FullscreenPass, Gpu};
use crate::technique::cascade;

/// Width and height of the texture in texels, a cell each.
pub(super) const TEXELS: [u32; 2] = [256; 2];

/// Pipelines for L terms.
#[derive(Debug)]
pub(crate) struct Passes {
    pub(super) fill: FullscreenPass,
    pub(super) blur: FullscreenPass,
    pub(super) sum: FullscreenPass,
}

/// Maps that materials use one after the other. In turns they have the light that the stages so far have spread, what is between two
/// axes, and the sums.
#[derive(Debug)]
pub(crate) struct Maps {
    pub(super) turns: [cascade::Maps; 3],
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

impl Maps {
    /// Bytes on the device.
    pub(crate) fn bytes_of(terms: usize) -> u64 {
        3 * cascade::Maps::bytes_of(TEXELS, terms)
    }

    pub(crate) fn new(gpu: &Gpu, terms: usize) -> Result<Self> {
        let map = |label| cascade::Maps::new(gpu, label, TEXELS, terms);
        Ok(Self { turns: [map("light volume")?, map("light volume, between")?, map("light volume, sums")?] })
    }

    /// Sums S_m after the last stage.
    pub(crate) fn sums(&self) -> &cascade::Maps {
        &self.turns[0]
    }
}
