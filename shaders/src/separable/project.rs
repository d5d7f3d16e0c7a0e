//! Coefficients of every pixel from the planes of a file, several pixels at a time.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::{BssrdfModel, SeparableBasis};

use crate::rgb::Rgb;

/// Pixels that are computed side by side.
const LANES: usize = 16;

/// Coefficients c_l(x) = Σ_h d_lh f_x(r_h), f_x = exp(½ P̂_x); shape `[L][height][width]`.
pub(super) fn coefficients(material: &Bssrdf<'_>, basis: &SeparableBasis<'_>) -> Vec<Rgb> {
    let terms = basis.size().terms;
    // Nodes without a factor are left out; of the others ½ P̂ of every base material stands in a row `[node][rgb]`.
    let samples = usize::from(material.header().samples);
    let counts = |h: &usize| (0..terms).any(|l| basis.projection(l, *h) != [0.0; 3]);
    let nodes: Vec<usize> = (0..samples).filter(counts).collect();
    let row = 3 * nodes.len();
    let factors: Vec<Vec<f32>> =
        (0..terms).map(|l| nodes.iter().flat_map(|h| basis.projection(l, *h)).collect()).collect();
    let halves = Halves::of(material, &nodes);

    let [width, height] = [material.header().width as usize, material.header().height as usize];
    let pixels = width * height;
    let mut all = vec![[0.0; 3]; terms * pixels];
    // ½ P̂, then f, `[node][rgb][lane]`.
    let mut block = vec![[0.0_f32; LANES]; row];
    for first in (0..pixels).step_by(LANES) {
        let count = LANES.min(pixels - first);
        for lane in 0..count {
            halves.write(first + lane, pixels, &mut block, lane);
        }
        for values in &mut block {
            *values = values.map(exp);
        }
        for (l, factors) in factors.iter().enumerate() {
            let mut sums = [[0.0_f32; LANES]; 3];
            for (values, factors) in block.as_chunks::<3>().0.iter().zip(factors.as_chunks::<3>().0) {
                for c in 0..3 {
                    for lane in 0..LANES {
                        sums[c][lane] += factors[c] * values[c][lane];
                    }
                }
            }
            for lane in 0..count {
                all[l * pixels + first + lane] = [0, 1, 2].map(|c| sums[c][lane]);
            }
        }
    }
    all
}

/// Halves of log-scale profiles, ½ P̂, at some nodes.
enum Halves<'a> {
    /// Of base materials, shape `[M][node][rgb]`, and what the pixels make of them.
    Bases { table: Vec<f32>, row: usize, mixtures: subsurf_decoder::bssrdf::Mixtures<'a>, count: usize },
    /// Of the pixels, whose planes are `[node][rgb]`.
    Pixels { planes: subsurf_decoder::bssrdf::PerPixelProfiles<'a>, nodes: Vec<usize> },
}

impl<'a> Halves<'a> {
    fn of(material: &Bssrdf<'a>, nodes: &[usize]) -> Self {
        let header = material.header();
        match *material.model() {
            BssrdfModel::BaseMaterials(planes) => {
                let samples = usize::from(header.samples);
                let bases = 0..header.base_materials as usize;
                let values = |base: usize| {
                    nodes.iter().flat_map(move |h| planes.profiles.rgb_at((base * samples + h) * 3).map(|p| 0.5 * p))
                };
                Self::Bases {
                    table: bases.flat_map(values).collect(),
                    row: 3 * nodes.len(),
                    mixtures: planes.mixtures,
                    count: header.model.into(),
                }
            }
            BssrdfModel::PerPixel(planes) => Self::Pixels { planes, nodes: nodes.to_vec() },
        }
    }

    /// Writes those of one pixel to a lane of the block.
    fn write(&self, pixel: usize, pixels: usize, block: &mut [[f32; LANES]], lane: usize) {
        match self {
            Self::Bases { table, row, mixtures, count } => {
                let mixture = mixtures.at(pixel, pixels);
                let part = |k: usize| (mixture.ratios[k], &table[usize::from(mixture.bases[k]) * row..][..*row]);
                let (t, values) = part(0);
                for (block, value) in block.iter_mut().zip(values) {
                    block[lane] = t * value;
                }
                for (t, values) in (1..*count).map(part) {
                    for (block, value) in block.iter_mut().zip(values) {
                        block[lane] += t * value;
                    }
                }
            }
            Self::Pixels { planes, nodes } => {
                let planes_of = nodes.iter().flat_map(|h| (0..3).map(move |c| 3 * h + c));
                for (block, plane) in block.iter_mut().zip(planes_of) {
                    block[lane] = 0.5 * planes.profiles.get(plane * pixels + pixel).unwrap_or(0.0);
                }
            }
        }
    }
}

/// e^x for −87 ≤ x ≤ 87, to 2 units of the last place: without branches, so that lanes are computed together.
fn exp(x: f32) -> f32 {
    /// Adding this leaves a number without its fraction, in the lowest bits.
    const WHOLE: f32 = 12_582_912.0;
    // ln 2 in two parts, of which the first has few bits: n ln 2 is exact.
    const LN_2: [f32; 2] = [0.693_359_4, -2.121_944_4e-4];
    let shifted = x * std::f32::consts::LOG2_E + WHOLE;
    let n = shifted - WHOLE;
    let r = (x - n * LN_2[0]) - n * LN_2[1];
    // The exponential series to the seventh power, |r| ≤ ½ ln 2.
    let series = [1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0_f32];
    let value = series.into_iter().reduce(|sum, term| sum * r + term).unwrap_or(1.0);
    // 2^n by the bits of the exponent.
    let power = f32::from_bits(shifted.to_bits().wrapping_add(127) << 23);
    value * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_is_one() {
        for k in -21_750_i16..=21_750 {
            let x = f32::from(k) / 500.0;
            let (found, expected) = (f64::from(exp(x)), f64::from(x).exp());
            assert!((found / expected - 1.0).abs() < 3e-7, "{x}: {found}, {expected}");
        }
    }
}
