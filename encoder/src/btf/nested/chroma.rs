//! Codebooks of chroma: tints of texels, and how chroma varies with directions beside them.

use nalgebra::DMatrix;
use subsurf_decoder::btf::Grid;

use super::database::{Chroma, Item};
use super::luma::Built;
use super::scales::gain;
use crate::math::k_means::weighted::Weighted;
use crate::math::matrix::product;
use crate::math::parallel;

/// Most entries of the codebooks of chroma.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChromaSizes {
    /// Entries of I2: chroma of 2-D slices.
    pub i2: usize,
    /// Entries of I1: chroma of 1-D slices.
    pub i1: usize,
    /// Entries of C: single colours.
    pub colours: usize,
    /// Entries of tints.
    pub tints: usize,
}

/// Chroma of all texels, to be stored beside a stage of luma.
pub(super) struct Hues<'a> {
    pub(super) grid: Grid,
    /// Ratio ρ of chroma to luma of all texels.
    pub(super) ratios: &'a [[f32; 2]],
    /// Coefficients v of chroma of all texels, in columns.
    pub(super) texels: &'a DMatrix<f32>,
    /// Components at nodes, without weights, of both channels.
    pub(super) tables: [&'a DMatrix<f32>; 2],
    /// Weights of nodes `[α][β]`.
    pub(super) node_weights: &'a [f32],
    /// Energy of luma of all texels.
    pub(super) energies: &'a [f32],
    /// Whether chroma is divided by luma.
    pub(super) is_relative: bool,
}

/// An error of chroma that cannot be seen, in means over texels: a quarter of an 8-bit step.
const INVISIBLE: f32 = 0.25 / 255.0;
const ROUNDS: usize = 12;

impl Hues<'_> {
    /// Codebooks that go with a stage; its P3 then leads to M.
    pub(super) fn build(&self, built: &mut Built, sizes: ChromaSizes) -> Chroma {
        let n_alpha = usize::from(self.grid.n_alpha);
        let slices = self.slices(built);
        // 2-D, 1-D, single colours; each level's vectors are the parts of the codewords above.
        let level2 =
            Weighted { dimensions: 2 * self.grid.light_nodes(), values: &slices.values, weights: &slices.weights };
        let (rows2, of_rows2) = level2.cluster(sizes.i2, ROUNDS);
        let level1 = Weighted { dimensions: level2.dimensions / n_alpha, values: &rows2, weights: &of_rows2 };
        let (rows1, of_rows1) = level1.cluster(sizes.i1, ROUNDS);
        let level0 = Weighted { dimensions: 2, values: &rows1, weights: &of_rows1 };
        let (hues, _) = level0.cluster(sizes.colours, ROUNDS);
        let (tints, texel_tints) = self.tints(sizes.tints);
        let (first, step) = range(&hues, &tints);
        let codes: Vec<[u8; 2]> = codes(&hues, first, step);
        let colours: Vec<f32> =
            codes.iter().flat_map(|code| [0, 1].map(|c: usize| first[c] + step[c] * f32::from(code[c]))).collect();
        // Bottom-up: every level chooses among what those below it decode to.
        let i1 = level0.nearest(&colours);
        let decoded1 = gathered(&colours, &i1, 2);
        let i2 = level1.nearest(&decoded1);
        let decoded2 = gathered(&decoded1, &i2, level1.dimensions);
        let of_slices = level2.nearest(&decoded2);
        let merged = merge(&mut built.chain.p3, &of_slices);
        let tint_codes = tints
            .as_chunks::<2>()
            .0
            .iter()
            .map(|tint| [0, 1].map(|c: usize| byte(tint[c] / step[c] + 128.0)))
            .collect();
        Chroma {
            merged,
            i2,
            i1,
            colours: codes,
            tints: tint_codes,
            texel_tints,
            first,
            step,
            is_relative: self.is_relative,
        }
    }

    /// Chroma of the 2-D parts of P3, `[entry][θ]`, both channels node by node, and its weights.
    fn slices(&self, built: &Built) -> Slices {
        let [n_phi, n_theta] = [self.grid.n_phi, self.grid.n_theta].map(usize::from);
        let light = self.grid.light_nodes();
        let chain = &built.chain;
        // Chroma relative to luma grows with g, absolute chroma does not.
        let of_gain = |g: f32| if self.is_relative { g } else { g * g };
        // v̄ = Σ g v / Σ g² of the texels of each entry of P4 (Σ g² v / Σ g² of absolute chroma), and Σ g².
        let entries = chain.p4.len() / n_phi;
        let mut means = DMatrix::<f32>::zeros(self.texels.nrows(), entries);
        let mut weights4 = vec![0.0_f32; entries];
        for (texel, item) in chain.texels.iter().enumerate() {
            let (entry, g) = (item.index as usize, gain(chain.scales[0], item.code, false));
            weights4[entry] += g * g;
            means.column_mut(entry).axpy(of_gain(g), &self.texels.column(texel), 1.0);
        }
        for (mut mean, weight) in means.column_iter_mut().zip(&weights4) {
            mean /= weight.max(f32::MIN_POSITIVE);
        }
        let tables = self.tables.map(|tables| product(tables, &means));
        // Σ w g A / Σ w g², likewise, of the parts of P4 that each entry of P3 stands for.
        let part = n_theta * light;
        let mut members = vec![Vec::new(); chain.p3.len() / n_theta];
        for (number, item) in chain.p4.iter().enumerate() {
            members[item.index as usize].push(number);
        }
        let of_entry = |members: &Vec<usize>| {
            let mut sums = [vec![0.0_f32; part], vec![0.0_f32; part]];
            let mut total = 0.0_f32;
            for &number in members {
                let g = gain(chain.scales[1], chain.p4[number].code, false);
                let weight = weights4[number / n_phi] * of_gain(g);
                total += weights4[number / n_phi] * g * g;
                for (sums, tables) in sums.iter_mut().zip(&tables) {
                    let values = &tables.as_slice()[number * part..][..part];
                    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
                }
            }
            // What P3 decodes to is any member's decoded part over its gain; without members it does not matter.
            let luma: Vec<f32> = members.first().map_or_else(
                || vec![0.0; part],
                |number| {
                    let g = gain(chain.scales[1], chain.p4[*number].code, false);
                    built.decoded.as_slice()[number * part..][..part].iter().map(|value| value / g).collect()
                },
            );
            let mut values = Vec::with_capacity(2 * part);
            let mut weights = Vec::with_capacity(2 * part);
            for node in 0..part {
                let y = luma[node];
                let [a, b] = [sums[0][node], sums[1][node]].map(|sum| sum / total.max(f32::MIN_POSITIVE));
                let weight = total * self.node_weights[node % light];
                if self.is_relative {
                    let divide = |value: f32| if y > 1e-6 { (value / y).clamp(-2.0, 2.0) } else { 0.0 };
                    values.extend([divide(a), divide(b)]);
                    weights.extend([weight * y * y; 2]);
                } else {
                    values.extend([a, b]);
                    weights.extend([weight; 2]);
                }
            }
            (values, weights)
        };
        let entries = parallel::map(members.len(), |entry| of_entry(&members[entry]));
        let (values, weights): (Vec<_>, Vec<_>) = entries.into_iter().unzip();
        Slices { values: values.concat(), weights: weights.concat() }
    }

    /// Few tints that are near all ρ, and the tint of each texel; none where ρ is zero everywhere.
    fn tints(&self, most: usize) -> (Vec<f32>, Vec<u32>) {
        if self.ratios.iter().flatten().all(|ratio| *ratio == 0.0) {
            return (Vec::new(), Vec::new());
        }
        let weights: Vec<f32> = self.energies.iter().flat_map(|energy| [*energy; 2]).collect();
        let all = Weighted { dimensions: 2, values: self.ratios.as_flattened(), weights: &weights };
        let mean_luma = 0.4;
        let mut count = 1;
        loop {
            let (tints, _) = all.cluster(count, ROUNDS);
            let nearest = all.nearest(&tints);
            let error = all.error(&tints, &nearest).sqrt() * mean_luma;
            if error < INVISIBLE || count >= most {
                return (tints, nearest);
            }
            count = (2 * count).min(most);
        }
    }
}

struct Slices {
    values: Vec<f32>,
    weights: Vec<f32>,
}

/// Chroma of code 0 and of a step, so that colours and tints both fit into bytes.
fn range(colours: &[f32], tints: &[f32]) -> ([f32; 2], [f32; 2]) {
    let of = |channel: usize| {
        let colours = || colours.iter().skip(channel).step_by(2).copied();
        let (low, high) = (colours().fold(f32::INFINITY, f32::min), colours().fold(f32::NEG_INFINITY, f32::max));
        let tint = tints.iter().skip(channel).step_by(2).fold(0.0_f32, |most, tint| most.max(tint.abs()));
        (low, ((high - low) / 255.0).max(tint / 127.0).max(1e-5))
    };
    let ((first_a, step_a), (first_b, step_b)) = (of(0), of(1));
    ([first_a, first_b], [step_a, step_b])
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
fn byte(value: f32) -> u8 {
    value.round().clamp(0.0, 255.0) as u8
}

fn codes(colours: &[f32], first: [f32; 2], step: [f32; 2]) -> Vec<[u8; 2]> {
    let code = |colour: &[f32; 2]| [0, 1].map(|c: usize| byte((colour[c] - first[c]) / step[c]));
    colours.as_chunks::<2>().0.iter().map(code).collect()
}

/// Rows of `length` values by their numbers.
fn gathered(rows: &[f32], numbers: &[u32], length: usize) -> Vec<f32> {
    numbers.iter().flat_map(|number| rows[*number as usize * length..][..length].iter().copied()).collect()
}

/// M: all pairs of an entry of P2 and one of I2 that there are; items of P3 lead to them from now on.
fn merge(p3: &mut [Item], i2: &[u32]) -> Vec<[u32; 2]> {
    let mut merged: Vec<[u32; 2]> = p3.iter().zip(i2).map(|(item, i2)| [item.index, *i2]).collect();
    merged.sort_unstable();
    merged.dedup();
    for (item, i2) in p3.iter_mut().zip(i2) {
        let number = merged.binary_search(&[item.index, *i2]).expect("every pair is there");
        item.index = u32::try_from(number).expect("fewer than 2³² pairs");
    }
    merged
}
