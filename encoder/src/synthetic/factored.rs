//! A factored BTF of random numbers, a kilobyte of them.

use subsurf_decoder::Section;
use subsurf_decoder::btf::factored::layout::{CodewordStage, MAX_STAGES, TuckerShape};
use subsurf_decoder::btf::{BtfHeader, BtfModel, ColourEncoding, Grid, Material};

use crate::file::container;

/// Factors of one material of 3 × 2 texels with its mipmaps: numbers from a formula, and streams of any bytes, which are some
/// numbers in their range.
#[must_use]
pub fn factored() -> Vec<u8> {
    let grid = Grid { n_alpha: 3, n_beta: 4, n_theta: 2, n_phi: 3, ..Grid::PAPER };
    let encoding = ColourEncoding::Display { white: 1.0 };
    let header = BtfHeader { model: BtfModel::Factored, encoding, materials: 1, grid, texel_mm: None };
    let mut material = Material { name: [0; 24], width: 3, height: 2, levels: 2 };
    material.name[..8].copy_from_slice(b"factored");
    let mut stages = [CodewordStage::default(); MAX_STAGES];
    stages[0] = CodewordStage { words: 4, first: 0, count: 5 };
    let shape = TuckerShape { luma: 2, chroma: 1, view_axes: 2, light_axes: 3, stages, count: 1 };
    let byte = |k: usize| u8::try_from(k * 37 % 251).expect("below 251");
    let bytes = |count: usize| (0..count).map(byte).collect::<Vec<u8>>();
    // Steps of ρ, scales and steps of columns, scales of axes.
    let steps = [2, shape.columns(), shape.columns(), 2, 3].into_iter().zip([0.01_f32, 0.001, 0.5, 0.02, 0.02]);
    let steps = steps.flat_map(|(count, step)| std::iter::repeat_n(step, count)).flat_map(f32::to_le_bytes);
    let indices: Vec<u8> = (0..material.texels(2)).map(|texel| [3, 0, 2, 1][texel as usize % 4]).collect();
    container::write([
        (Section::BtfHeader, &header.to_bytes()[..]),
        (Section::Materials, &material.to_bytes()),
        (Section::TuckerHeader, &shape.to_bytes().chain(steps).collect::<Vec<u8>>()),
        (Section::Axes, &bytes(2 * grid.view_nodes() + 3 * grid.light_nodes())),
        (Section::Core, &bytes(64)),
        (Section::Codewords, &bytes(64)),
        (Section::TexelIndices, &indices),
    ])
}
