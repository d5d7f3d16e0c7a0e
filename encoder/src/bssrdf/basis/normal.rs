//! Normal equations of the fit: the exact derivatives of the exitance by every unknown.
//!
//! With T_ah = G_a * (f_h E) and B_la = G_a * (c_l E) = Σ_h d_lh T_ah,
//!
//! ∂M/∂d_lh = f_h Σ_ma w_lma B_ma + Σ_a (Σ_m w_lma c_m) T_ah,
//! ∂M/∂w_lma = c_m B_la + (l ≠ m) c_l B_ma,
//! ∂M/∂ln σ_a = Σ_lm w_lma c_m ∂B_la/∂ln σ_a.
//!
//! The last is that of the heat equation, ∂G/∂V = ½ ∇²G with V the variance: exact for wide Gaussians.

use nalgebra::DMatrix;

use super::params::Params;
use super::patch::{Lit, Patch};
use crate::math::parallel;

/// Samples whose rows are multiplied at a time.
const ROWS: usize = 256;

/// Jᵀ J of one channel, in the order d, w, ln σ, and last the residual.
pub(super) struct Normal(pub(super) DMatrix<f64>);

/// Normal equations of each channel over all patches and lights; sums have a fixed order.
pub(super) fn normals(params: &Params, patches: &[Patch]) -> [Normal; 3] {
    [0, 1, 2].map(|c| {
        let tasks: Vec<(&Patch, &Lit)> =
            patches.iter().flat_map(|patch| patch.lit.iter().map(move |lit| (patch, lit))).collect();
        let all = parallel::map(tasks.len(), |k| of_light(params, tasks[k].0, tasks[k].1, c));
        Normal(all.into_iter().reduce(|sum, normal| sum + normal).expect("there is uniform light at least"))
    })
}

/// Blurs of one light.
struct Blurred {
    /// T_ah at the samples, shape `[a][node][sample]`.
    nodes: Vec<Vec<Vec<f32>>>,
    /// B_la, shape `[l][a][pixel]`.
    maps: Vec<Vec<Vec<f32>>>,
}

impl Blurred {
    fn new(params: &Params, patch: &Patch, lit: &Lit, c: usize) -> Self {
        let (terms, gaussians) = (params.size.terms, params.size.gaussians);
        let cascade = params.cascade();
        let mut nodes = vec![Vec::new(); gaussians];
        let mut maps = vec![vec![vec![0.0_f32; patch.pixels()]; gaussians]; terms];
        let mut between = vec![0.0; patch.pixels()];
        for (k, f) in patch.f[c].iter().enumerate() {
            let mut map: Vec<f32> = f.iter().zip(&lit.irradiance).map(|(f, e)| f * e).collect();
            for (a, stage) in cascade.stages().iter().enumerate() {
                stage.blur(&mut map, &mut between, patch.size, patch.addressing);
                nodes[a].push(patch.samples.iter().map(|sample| map[*sample]).collect());
                for (l, maps) in maps.iter_mut().enumerate() {
                    #[allow(clippy::cast_possible_truncation, reason = "images are in single precision")]
                    let d = params.factors(l, c)[k] as f32;
                    maps[a].iter_mut().zip(&map).for_each(|(sum, blurred)| *sum += d * blurred);
                }
            }
        }
        Self { nodes, maps }
    }
}

/// Σ of the four neighbours less four times the pixel itself.
fn laplacian(map: &[f32], patch: &Patch, sample: usize) -> f64 {
    let [width, height] = patch.size;
    let place = [sample as u64 % u64::from(width), sample as u64 / u64::from(width)];
    let [x, y] = place.map(|k| i32::try_from(k).expect("a side is below 65,536"));
    let at = |x: i32, y: i32| {
        let [x, y] = [patch.addressing.map(x, width), patch.addressing.map(y, height)];
        f64::from(map[y as usize * width as usize + x as usize])
    };
    at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1) - 4.0 * at(x, y)
}

/// ½ ∂V/∂ln σ of a Gaussian at whole pixels, V its variance; σ² for wide ones.
fn half_growth(sigma: f64) -> f64 {
    let variance = |sigma: f64| {
        let weight = |k: i32| (-0.5 * (f64::from(k) / sigma).powi(2)).exp();
        let (sum, moment) =
            (-40..=40).fold((0.0, 0.0), |(sum, moment), k| (sum + weight(k), moment + weight(k) * f64::from(k * k)));
        moment / sum
    };
    if sigma > 3.0 { sigma * sigma } else { 0.5 * (variance(1.01 * sigma) - variance(sigma)) / 1.01_f64.ln() }
}

fn of_light(params: &Params, patch: &Patch, lit: &Lit, c: usize) -> DMatrix<f64> {
    let (size, count) = (params.size, patch.f[c].len());
    let (terms, gaussians) = (size.terms, size.gaussians);
    let blurred = Blurred::new(params, patch, lit, c);
    let coefficients: Vec<Vec<f32>> = (0..terms).map(|l| patch.coefficients(params, l, c)).collect();
    let growth: Vec<f64> = params.sigmas().map(half_growth).collect();
    let unknowns = params.of_channel() + gaussians;
    let mut normal = DMatrix::zeros(unknowns + 1, unknowns + 1);
    for first in (0..patch.samples.len()).step_by(ROWS) {
        let samples = &patch.samples[first..(first + ROWS).min(patch.samples.len())];
        let mut rows = DMatrix::zeros(unknowns + 1, samples.len());
        for ((k, sample), mut row) in (first..).zip(samples).zip(rows.column_iter_mut()) {
            let own: Vec<f64> = coefficients.iter().map(|of_term| f64::from(of_term[*sample])).collect();
            let map = |l: usize, a: usize| f64::from(blurred.maps[l][a][*sample]);
            let mut found = 0.0;
            for l in 0..terms {
                // S_l, and what every G_a of the light beside f_h counts for.
                let sum: f64 = (0..terms)
                    .flat_map(|m| (0..gaussians).map(move |a| (m, a)))
                    .map(|(m, a)| params.weight(l, m, a, c) * map(m, a))
                    .sum();
                found += own[l] * sum;
                let of_terms = |a: usize| (0..terms).map(|m| params.weight(l, m, a, c) * own[m]).sum::<f64>();
                let shares: Vec<f64> = (0..gaussians).map(of_terms).collect();
                for h in 0..count {
                    let beside: f64 = (0..gaussians).map(|a| shares[a] * f64::from(blurred.nodes[a][h][k])).sum();
                    row[l * count + h] = f64::from(patch.f[c][h][*sample]) * sum + beside;
                }
                for a in 0..gaussians {
                    let change = growth[a] * laplacian(&blurred.maps[l][a], patch, *sample);
                    row[params.of_channel() + a] += shares[a] * change;
                    for m in l..terms {
                        let at = terms * count + size.pair(l, m) * gaussians + a;
                        row[at] = own[m] * map(l, a) + if l == m { 0.0 } else { own[l] * map(m, a) };
                    }
                }
            }
            row[unknowns] = f64::from(lit.target[c][k]) - found;
            row *= lit.inverse_peak;
        }
        normal.gemm(1.0, &rows, &rows.transpose(), 1.0);
    }
    normal
}
