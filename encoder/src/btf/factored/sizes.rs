//! Sizes of files of factors.

use subsurf_decoder::btf::factored::layout::{MAX_CHROMA, MAX_LUMA, MAX_STAGES};

use super::angles::CoreSize;
use super::texels::StageSize;
use crate::error::{Error, Result};

/// Numbers and steps of one file.
#[derive(Clone, Debug, PartialEq)]
pub struct Sizes {
    /// Most components of luma, 1 to 128.
    pub luma: usize,
    /// Most components of chroma beyond what follows luma, 0 to 32.
    pub chroma: usize,
    /// Stages of codewords of texels, 1 to 32.
    pub stages: Vec<StageSize>,
    /// Most axes of views and of lights, 1 to 255 each.
    pub axes: [usize; 2],
    /// Size of the core between the axes.
    pub core: CoreSize,
    /// Step of codewords, in units of the decomposition's coefficients.
    pub word_step: f32,
}

/// Share of a file for a byte per texel and stage; what no share is for is left for codewords.
const OF_INDICES: f64 = 0.42;
/// Share of a file for the core between the axes.
pub(super) const OF_CORE: f64 = 0.23;
/// Share of a file for the axes of views and of lights.
const OF_AXES: f64 = 0.07;
/// Bytes that a number of a codeword takes, about.
const OF_WORD: f64 = 0.3;
/// Step of codewords, in units of the decomposition's coefficients: finer ones would cost more than they gain.
const WORD_STEP: f32 = 0.1;
impl Sizes {
    /// Sizes of a file of about so many bytes, found on simulated materials of 128 × 128 texels at 1:500 to 1:2000.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    pub fn for_bytes(bytes: usize, texels: usize, nodes: [usize; 2]) -> Self {
        let of = |share: f64| share * bytes as f64;
        let stages = (of(OF_INDICES) / texels.max(1) as f64).round().clamp(1.0, MAX_STAGES as f64);
        let left = of(1.0 - OF_CORE - OF_AXES) - stages * texels as f64;
        let coefficients = left.max(0.0) / (256.0 * stages * OF_WORD);
        let chroma = (0.14 * coefficients).round().clamp(1.0, 16.0);
        let luma = (coefficients - 2.0 - chroma).round().clamp(4.0, f64::from(MAX_LUMA)) as usize;
        let axes = (of(OF_AXES) / (nodes[0] + nodes[1]).max(1) as f64).round().clamp(4.0, 255.0) as usize;
        let stage = StageSize { words: 256, count: 2 + chroma as usize + luma };
        Self {
            luma,
            chroma: chroma as usize,
            stages: vec![stage; stages as usize],
            axes: [axes; 2],
            core: CoreSize::Bytes(of(OF_CORE) as usize),
            word_step: WORD_STEP,
        }
    }

    pub(super) fn check(&self) -> Result<()> {
        let (luma, chroma) = (usize::from(MAX_LUMA), usize::from(MAX_CHROMA));
        let ranges = [
            ("components of luma", self.luma, 1, luma),
            ("components of chroma", self.chroma, 0, chroma),
            ("stages of codewords", self.stages.len(), 1, MAX_STAGES),
            ("axes of views", self.axes[0], 1, 255),
            ("axes of lights", self.axes[1], 1, 255),
        ];
        for (what, number, least, most) in ranges {
            if !(least..=most).contains(&number) {
                return Err(Error::Request(format!("{number} {what}; {least} to {most} are possible")));
            }
        }
        if let CoreSize::Step(step) = self.core {
            positive("step of the core", step)?;
        }
        positive("step of codewords", self.word_step)
    }
}

/// Refuses a number that is not above 0.
pub(super) fn positive(what: &str, number: f32) -> Result<()> {
    if number.is_finite() && number > 0.0 {
        return Ok(());
    }
    Err(Error::Request(format!("a {what} of {number}; it is above 0")))
}
