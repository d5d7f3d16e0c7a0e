//! Coefficients of texels as sums of codewords, one from each stage.

use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use crate::math::k_means::KMeans;
use crate::math::k_means::euclidean::{Choice, Euclidean};
use crate::math::parallel;
use crate::progress::Progress;

/// Size of one stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageSize {
    /// Number of codewords, 1 to 256.
    pub words: usize,
    /// Coefficients they add to, from the first; fewer than there are leave out the least of luma.
    pub count: usize,
}

/// Coefficients of texels as sums of codewords.
pub(super) struct Quantised {
    /// For every stage `[coefficient × codeword]`, in steps.
    pub(super) words: Vec<DMatrix<f32>>,
    /// `[texel][stage]`.
    pub(super) indices: Vec<u8>,
}

/// Rounds of k-means that a stage begins with.
const FIRST_ROUNDS: usize = 8;
/// Sweeps over all stages that follow.
const SWEEPS: usize = 24;
/// The last of them, in which codewords are rounded.
const WHOLE_SWEEPS: usize = 8;

/// Progress steps of [`quantise`] for so many stages.
pub(super) fn steps(stages: usize) -> u64 {
    (stages * (FIRST_ROUNDS + SWEEPS)) as u64
}

/// Adds the chosen codewords, times `sign`.
fn add(columns: &mut DMatrix<f32>, chosen: &[Choice], words: &DMatrix<f32>, sign: f32) {
    let (rows, count) = (columns.nrows(), words.nrows());
    parallel::for_chunks(columns.as_mut_slice(), rows, |number, column| {
        let word = words.column(usize::from(chosen[number].0));
        column[..count].iter_mut().zip(word.iter()).for_each(|(value, other)| *value += sign * other);
    });
}

/// Codewords, in steps, for columns of coefficients, in steps.
pub(super) fn quantise(columns: &DMatrix<f32>, sizes: &[StageSize], seed: u64, progress: &dyn Progress) -> Quantised {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut left = columns.clone();
    let (mut words, mut chosen): (Vec<DMatrix<f32>>, Vec<Vec<Choice>>) = (Vec::new(), Vec::new());
    for size in sizes {
        let count = size.count.clamp(1, columns.nrows());
        let number = size.words.clamp(1, 256).min(columns.ncols());
        let mut of_stage = DMatrix::zeros(count, number);
        for mut word in of_stage.column_iter_mut() {
            word.copy_from(&left.column(rng.random_range(0..left.ncols())).rows(0, count));
        }
        let vectors = Euclidean(&left);
        let of_stage = vectors.lloyd(of_stage, FIRST_ROUNDS, |_| {
            progress.advance(1);
            true
        });
        let of_texels = vectors.assign(&of_stage);
        add(&mut left, &of_texels, &of_stage, -1.0);
        words.push(of_stage);
        chosen.push(of_texels);
    }
    for sweep in 0..SWEEPS {
        // Towards the end, codewords are whole, and those of other stages make up for it; at last only choices change.
        let (is_whole, is_last) = (sweep + WHOLE_SWEEPS >= SWEEPS, sweep + 1 == SWEEPS);
        for (of_stage, of_texels) in words.iter_mut().zip(&mut chosen) {
            add(&mut left, of_texels, of_stage, 1.0);
            let vectors = Euclidean(&left);
            *of_texels = vectors.assign(of_stage);
            if !is_last {
                vectors.update(of_texels, of_stage);
            }
            if is_whole {
                of_stage.apply(|value| *value = value.round().clamp(-32_767.0, 32_767.0));
            }
            add(&mut left, of_texels, of_stage, -1.0);
            progress.advance(1);
        }
    }
    let (words, chosen) = carrying(words, chosen);
    let texels = 0..columns.ncols();
    Quantised { words, indices: texels.flat_map(|texel| chosen.iter().map(move |stage| stage[texel].0)).collect() }
}

/// Stages that add something to a texel, one at least: others would cost a byte of each texel.
fn carrying(words: Vec<DMatrix<f32>>, chosen: Vec<Vec<Choice>>) -> (Vec<DMatrix<f32>>, Vec<Vec<Choice>>) {
    let adds = |words: &DMatrix<f32>, chosen: &[Choice]| {
        chosen.iter().any(|choice| words.column(usize::from(choice.0)).iter().any(|value| *value != 0.0))
    };
    let carry: Vec<bool> = words.iter().zip(&chosen).map(|(words, chosen)| adds(words, chosen)).collect();
    let none = !carry.contains(&true);
    let stages = words.into_iter().zip(chosen).zip(carry).enumerate();
    stages.filter(|(number, (_, carries))| *carries || none && *number == 0).map(|(_, (stage, _))| stage).unzip()
}
