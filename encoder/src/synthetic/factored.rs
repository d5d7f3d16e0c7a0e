//! A factored BTF of numbers from formulas, a kilobyte of them.

use nalgebra::DMatrix;
use subsurf_decoder::Section;
use subsurf_decoder::btf::factored::layout::{CodewordStage, MAX_STAGES, TuckerShape};
use subsurf_decoder::btf::{BtfHeader, BtfModel, ColourEncoding, Grid, Material};

use crate::btf::factored::{codewords, core};
use crate::file::container;

/// Factors of one material of 3 × 2 texels with its mipmaps. The first axes are even, others wave; a number of the core is as large as they
/// get. Of one to three `stages` of codewords the later ones add to fewer coefficients.
///
/// # Panics
/// For another number of stages.
#[must_use]
pub fn factored(stages: usize) -> Vec<u8> {
    const STAGES: [CodewordStage; 3] = [
        CodewordStage { words: 4, first: 0, count: 5 },
        CodewordStage { words: 3, first: 1, count: 2 },
        CodewordStage { words: 256, first: 4, count: 1 },
    ];
    let (used, count) = (&STAGES[..stages], u8::try_from(stages).expect("one to three"));
    let grid = Grid { n_alpha: 3, n_beta: 4, n_theta: 2, n_phi: 3, ..Grid::PAPER };
    let encoding = ColourEncoding::Display { white: 1.0 };
    let header = BtfHeader { model: BtfModel::Factored, encoding, materials: 1, grid, texel_mm: None };
    let mut material = Material { name: [0; 24], width: 3, height: 2, levels: 2 };
    material.name[..8].copy_from_slice(b"factored");
    let mut stages = [CodewordStage::default(); MAX_STAGES];
    stages[..used.len()].copy_from_slice(used);
    let shape = TuckerShape { luma: 2, chroma: 1, view_axes: 2, light_axes: 3, stages, count };
    let (views, lights) = (grid.view_nodes(), grid.light_nodes());
    let axis = |first: usize, count: usize| (0..count).map(move |k| if k < first { 100 } else { wave(k, 120) });
    let axes: Vec<u8> = axis(views, 2 * views).chain(axis(lights, 3 * lights)).map(|n| n.to_le_bytes()[0]).collect();
    // Luma is mostly the first component, of even axes.
    let of_column =
        |column: usize| (0..6).map(move |k| if column == 0 && k == 0 { 50 } else { wave(7 * column + k, 13) });
    let mut columns: Vec<Vec<i32>> = (0..shape.columns()).map(|column| of_column(column).collect()).collect();
    columns[2][5] = 3_000;
    let words: Vec<DMatrix<f32>> = used
        .iter()
        .map(|stage| {
            let mean = |row: usize| if usize::from(stage.first) + row == 3 { 5.0 } else { 0.0 };
            #[allow(clippy::cast_precision_loss, reason = "a few")]
            DMatrix::from_fn(stage.count.into(), stage.words.into(), |row, word| {
                mean(row) + wave(11 * row + word, 4) as f32
            })
        })
        .collect();
    // Steps of ρ, scales and steps of columns, scales of axes.
    let steps = [2, shape.columns(), shape.columns(), 2, 3].into_iter().zip([0.01_f32, 0.001, 0.5, 0.02, 0.02]);
    let steps = steps.flat_map(|(count, step)| std::iter::repeat_n(step, count)).flat_map(f32::to_le_bytes);
    let index = |texel: u32| used.iter().zip(0..).map(move |(stage, k)| (3 + 5 * texel + k) % u32::from(stage.words));
    let indices = (0..material.texels(2)).flat_map(index);
    let indices: Vec<u8> = indices.map(|index| u8::try_from(index).expect("less than 256 words")).collect();
    container::write([
        (Section::BtfHeader, &header.to_bytes()[..]),
        (Section::Materials, &material.to_bytes()),
        (Section::TuckerHeader, &shape.to_bytes().chain(steps).collect::<Vec<u8>>()),
        (Section::Axes, &axes),
        (Section::Core, &core(&columns, 3)),
        (Section::Codewords, &codewords(&words)),
        (Section::TexelIndices, &indices),
    ])
}

/// Whole numbers from −`most` to `most`, that follow each other in no simple order.
fn wave(k: usize, most: i32) -> i32 {
    i32::try_from(k * 37 % 251).expect("below 251") % (2 * most + 1) - most
}
