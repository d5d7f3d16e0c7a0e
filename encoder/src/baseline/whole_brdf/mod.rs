//! What simpler codecs make of the same materials at the same number of bytes: yardsticks, without a file of their own.
//!
//! All of them work on whole apparent BRDFs, the three channels of a texel at all measured pairs, in the coordinates of a
//! truncated SVD and with its weights. Only [`one_level`] is resampled to a grid; [`pca`] and [`local_pca`] are given the
//! measured directions, which spares them the loss of resampling and takes fewer bytes than a grid.

mod pca;
mod space;

use nalgebra::DMatrix;
use subsurf_decoder::btf::{ColourEncoding, Grid};

use crate::btf::{Measured, Resampler, TruncatedSvd};
use crate::capture::Images;
pub use pca::{local_pca, local_pca_bytes};
use space::Whole;

/// A material as a codec gives it back.
pub struct Baseline {
    /// Bytes that it takes, without any header.
    pub bytes: u64,
    tone: ColourEncoding,
    parts: Vec<Part>,
    /// Number of the part that every texel belongs to.
    part_of: Vec<u8>,
}

/// Texels that share functions.
struct Part {
    /// `[3 · pair + channel × component]`; the first is a mean, whose coefficient is 1, where there is one.
    functions: DMatrix<f32>,
    /// `[component × texel]`, of all texels.
    coefficients: DMatrix<f32>,
}

impl Baseline {
    /// The image of a pair of directions, as images have it: not clipped.
    #[must_use]
    pub fn image(&self, pair: usize) -> Vec<[f32; 3]> {
        let rows: Vec<DMatrix<f32>> =
            self.parts.iter().map(|part| part.functions.rows(3 * pair, 3) * &part.coefficients).collect();
        let value = |(texel, part): (usize, &u8)| {
            let channels = rows[usize::from(*part)].column(texel);
            self.tone.decode([channels[0], channels[1], channels[2]])
        };
        self.part_of.iter().enumerate().map(value).collect()
    }
}

/// Bytes of [`one_level`] of `words` codewords.
#[must_use]
pub fn one_level_bytes(words: usize, texels: usize, grid: &Grid) -> u64 {
    // A table of 8 bits a channel, and its first value and step in all three.
    let word = 3 * grid.light_nodes() * grid.view_nodes() + 3 * 8;
    (words * word + (texels * bits(words)).div_ceil(8)) as u64
}

/// Bits that tell `count` things apart.
fn bits(count: usize) -> usize {
    count.next_power_of_two().trailing_zeros() as usize
}

/// Vector quantisation of whole apparent BRDFs: `words` of them, 2 to 256, stored in 8 bits over a grid.
#[must_use]
pub fn one_level(images: &Images, svd: &TruncatedSvd, grid: &Grid, words: usize, seed: u64) -> Baseline {
    let whole = Whole::new(svd);
    let (means, part_of) = pca::k_means(&whole.texels, words, seed);
    let resampler = Resampler::new(grid, images.lights(), images.views());
    let measured = Measured::new(grid, images.lights(), images.views());
    let functions = whole.functions(&means);
    let parts = functions
        .column_iter()
        .map(|word| {
            let mut read = DMatrix::zeros(functions.nrows(), 1);
            for channel in 0..3 {
                let values: Vec<f32> = word.iter().skip(channel).step_by(3).copied().collect();
                let mut table = resampler.fit(&values);
                in_8_bits(&mut table);
                for (pair, value) in measured.read(&table).into_iter().enumerate() {
                    read[3 * pair + channel] = value;
                }
            }
            Part { functions: read, coefficients: DMatrix::from_element(1, part_of.len(), 1.0) }
        })
        .collect();
    Baseline { bytes: one_level_bytes(words, svd.texels(), grid), tone: svd.tone, parts, part_of }
}

/// Bytes of [`pca`] of `components`.
#[must_use]
pub fn pca_bytes(components: usize, texels: usize, pairs: usize) -> u64 {
    // Functions and coefficients in 8 bits, and a step for each.
    (components * (3 * pairs + texels + 8)) as u64
}

/// Principal components of the matrix of texels and directions, all channels in one, functions and coefficients in
/// 8 bits.
#[must_use]
pub fn pca(svd: &TruncatedSvd, components: usize) -> Baseline {
    let whole = Whole::new(svd);
    let axes = pca::principal(&whole.texels, components);
    let mut functions = whole.functions(&axes);
    let mut coefficients = axes.tr_mul(&whole.texels);
    signed_columns(&mut functions);
    signed_rows(&mut coefficients);
    let (texels, pairs) = (svd.texels(), svd.weights.len());
    Baseline {
        bytes: pca_bytes(components, texels, pairs),
        tone: svd.tone,
        parts: vec![Part { functions, coefficients }],
        part_of: vec![0; texels],
    }
}

/// Rounds values to 256 levels from their least to their largest.
fn in_8_bits(values: &mut [f32]) {
    let least = values.iter().copied().fold(f32::INFINITY, f32::min);
    let step = (values.iter().copied().fold(least, f32::max) - least).max(1e-12) / 255.0;
    values.iter_mut().for_each(|value| *value = ((*value - least) / step).round() * step + least);
}

/// Rounds values to 255 levels around 0.
fn signed<'a>(values: impl Iterator<Item = &'a mut f32>) {
    let values: Vec<&mut f32> = values.collect();
    let step = values.iter().fold(1e-12_f32, |largest, value| largest.max(value.abs())) / 127.0;
    values.into_iter().for_each(|value| *value = (*value / step).round() * step);
}

fn signed_columns(matrix: &mut DMatrix<f32>) {
    matrix.column_iter_mut().for_each(|mut column| signed(column.iter_mut()));
}

fn signed_rows(matrix: &mut DMatrix<f32>) {
    matrix.row_iter_mut().for_each(|mut row| signed(row.iter_mut()));
}

#[cfg(test)]
#[allow(clippy::cast_possible_truncation, reason = "small numbers")]
mod tests;
