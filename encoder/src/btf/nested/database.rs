//! Nested codebooks as they are made, before they are packed into a file.

use subsurf_decoder::btf::nested::layout::{SLICE_STEPS_PER_OCTAVE, Scales};
use subsurf_decoder::btf::{BtfHeader, Material};

/// A file of nested codebooks before it is packed.
#[derive(Clone, Debug, PartialEq)]
pub struct Database {
    /// Grid, tone and number of materials.
    pub header: BtfHeader,
    /// The materials; texels of all levels of the first stand first.
    pub materials: Vec<Material>,
    /// One to four additive stages of luma.
    pub stages: Vec<Chain>,
    /// Chroma, which comes with the first stage.
    pub chroma: Chroma,
}

/// An index into the codebook below, and the code of a scale; its highest bit is the sign where the stage is signed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Item {
    /// Entry of the codebook below.
    pub index: u32,
    /// Code of the scale, see [`Scales`].
    pub code: u32,
}

/// One additive stage of luma.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Chain {
    /// P6, an item for every texel, row by row, level by level, material by material.
    pub texels: Vec<Item>,
    /// P4, rows of n_φ items that lead to P3.
    pub p4: Vec<Item>,
    /// P3, rows of n_θ items that lead to M, or to P2 in later stages.
    pub p3: Vec<Item>,
    /// P2, rows of n_α items that lead to P1.
    pub p2: Vec<Item>,
    /// P1, rows of n_β values, 255 standing for 1, or 127 where signed, and the code of their mean ([`slice_mean`]).
    pub p1: Vec<u8>,
    /// Scales of P6, P4, P3 and P2.
    pub scales: [Scales; 4],
    /// Whether values of P1 and scales have signs; not in the first stage.
    pub is_signed: bool,
}

/// Codebooks of chroma.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chroma {
    /// M: entries of P2 of the first stage and of I2.
    pub merged: Vec<[u32; 2]>,
    /// I2, rows of n_α entries of I1.
    pub i2: Vec<u32>,
    /// I1, rows of n_β entries of C.
    pub i1: Vec<u32>,
    /// C: colours, two codes each.
    pub colours: Vec<[u8; 2]>,
    /// Tints: what is added to the chroma of whole texels, two codes around 128 each; empty for none.
    pub tints: Vec<[u8; 2]>,
    /// The tint of every texel; empty where there are none.
    pub texel_tints: Vec<u32>,
    /// Chroma that code 0 stands for, in both channels.
    pub first: [f32; 2],
    /// Chroma of one step of a code, in both channels.
    pub step: [f32; 2],
    /// Whether chroma is divided by luma.
    pub is_relative: bool,
}

/// Code of the mean of a row of P1, which stands after it: μ, where 2^((μ − 255)/32) is the mean of its piecewise linear function between the
/// outermost nodes, 255 counting as 1. Of signed rows it is not used.
#[must_use]
pub fn slice_mean(values: &[u8]) -> u8 {
    let ends = [values.first(), values.last()].map(|end| f32::from(end.copied().unwrap_or(0)));
    let sum = values.iter().map(|value| f32::from(*value)).sum::<f32>() - 0.5 * (ends[0] + ends[1]);
    #[allow(clippy::cast_precision_loss, reason = "at most 64 nodes")]
    let mean = sum / (values.len().max(2) - 1) as f32 / 255.0;
    #[allow(clippy::cast_precision_loss, reason = "32")]
    let per_octave = SLICE_STEPS_PER_OCTAVE as f32;
    // Nothing has the least mean there is.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let code = (255.0 + per_octave * mean.log2()).round().clamp(0.0, 255.0) as u8;
    code
}
