//! Eq. 6 with its gradient: E_LS + λ_reg E_reg + λ_barr E_barr, indices fixed.

use subsurf_decoder::bssrdf::Mixture;

use super::EDGE;
use crate::bssrdf::model::Model;
use crate::bssrdf::normal::Normal;
use crate::bssrdf::normal::regulariser::SMOOTHNESS;
use crate::math::lanes::{self, ZERO};
use crate::math::lbfgs::{Bounds, Objective};
use crate::math::parallel;

/// λ_barr and γ.
const BARRIER: f64 = 1e-3;
const GAMMA: f64 = 1e-3;
/// First penalty ρ of a ratio sum's distance from 1, and its growth from round to round.
const PENALTY: f64 = 1e3;
const PENALTY_GROWTH: f64 = 1.3;

/// What keeps the ratios of every pixel adding up to 1, where they are independent.
pub(super) struct Multipliers {
    lambda: Vec<f64>,
    rho: f64,
}

impl Multipliers {
    pub(super) fn new(pixels: usize) -> Self {
        Self { lambda: vec![0.0; pixels], rho: PENALTY }
    }

    /// λ + ρ c, and a larger ρ.
    pub(super) fn update(&mut self, model: &Model) {
        for (lambda, mixture) in self.lambda.iter_mut().zip(&model.mixtures) {
            *lambda += self.rho * (mixture.ratios.iter().map(|&t| f64::from(t)).sum::<f64>() - 1.0);
        }
        self.rho *= PENALTY_GROWTH;
    }
}

/// Parameters are the profiles' coefficients `[M][S][rgb]`, relative to the mean profile, then the free ratios: none of
/// K = 1, t of K = 2 (1 − t is the other), all of K ≥ 3, pixel by pixel.
pub(super) struct Energy<'a> {
    normal: &'a Normal,
    /// Gives the indices and K; profiles and ratios come from the parameters.
    indices: &'a Model,
    multipliers: &'a Multipliers,
}

impl<'a> Energy<'a> {
    pub(super) fn new(normal: &'a Normal, model: &'a Model, multipliers: &'a Multipliers) -> Self {
        Self { normal, indices: model, multipliers }
    }

    /// Bounds of all parameters: ratios lie between 0 and 1, [`EDGE`] away from both.
    pub(super) fn bounds(&self) -> Bounds {
        let coefficients = self.indices.bases.len() * 3;
        let ratios = free_ratios(self.indices.per_pixel) * self.indices.mixtures.len();
        let bounds = |of_ratio: f64, otherwise: f64| {
            let mut bounds = vec![otherwise; coefficients];
            bounds.resize(coefficients + ratios, of_ratio);
            bounds
        };
        Bounds { lower: bounds(EDGE, f64::NEG_INFINITY), upper: bounds(1.0 - EDGE, f64::INFINITY) }
    }
}

impl Objective for Energy<'_> {
    fn evaluate(&self, parameters: &[f64]) -> (f64, Vec<f64>) {
        let model = with_parameters(self.indices, parameters);
        let normal = self.normal;
        let nodes = normal.geometry.nodes;
        let field = model.field(normal);
        let deltas = normal.deltas(&field);

        // ∂E_LS/∂p_x = A p_x + Σ_y φ n a aᵀ p_y − b of every pixel.
        let mut slopes = vec![ZERO; normal.geometry.pixels() * nodes];
        let costs: Vec<f64> = parallel::map_chunks(&mut slopes, nodes, |pixel, slope| {
            normal.image(&field, &deltas, pixel, slope);
            for (slope, b) in slope.iter_mut().zip(normal.b(pixel)) {
                for c in 0..4 {
                    slope[c] -= b[c];
                }
            }
            let [r, g, b, _] = lanes::dot(field.at(pixel), slope);
            let [r_b, g_b, b_b, _] = lanes::dot(field.at(pixel), normal.b(pixel));
            (r - r_b) + (g - g_b) + (b - b_b)
        });
        let mut cost = 0.5 * (costs.iter().sum::<f64>() + normal.y2);
        let slope_of = |pixel: usize| &slopes[pixel * nodes..][..nodes];

        // ∂/∂P̂_b = Σ_x t_xb ∂/∂p_x.
        let of_bases = model.gather(normal, |pixel, out| out.copy_from_slice(slope_of(pixel)));
        let mut gradient: Vec<f64> = of_bases.iter().flat_map(|node| [0, 1, 2].map(|c| f64::from(node[c]))).collect();
        cost += self.regulariser(parameters, &mut gradient);

        // ∂/∂t_xk = P̂_bk · ∂/∂p_x.
        let free = free_ratios(model.per_pixel);
        let along = |pixel: usize, k: usize| -> f64 {
            let base = usize::from(model.mixtures[pixel].bases[k]) * nodes;
            lanes::dot(&model.bases[base..][..nodes], slope_of(pixel)).iter().sum()
        };
        for pixel in 0..normal.geometry.pixels() {
            let t = &parameters[3 * self.indices.bases.len() + pixel * free..][..free];
            match *t {
                [] => {}
                [t] => {
                    let (first, second) = (barrier(t), barrier(1.0 - t));
                    cost += first.0 + second.0;
                    gradient.push(along(pixel, 0) - along(pixel, 1) + first.1 - second.1);
                }
                _ => {
                    // λ c + ½ ρ c² with c = Σ t − 1.
                    let (lambda, rho) = (self.multipliers.lambda[pixel], self.multipliers.rho);
                    let c = t.iter().sum::<f64>() - 1.0;
                    cost += lambda * c + 0.5 * rho * c * c;
                    for (k, &t) in t.iter().enumerate() {
                        let (value, slope) = barrier(t);
                        cost += value;
                        gradient.push(along(pixel, k) + slope + lambda + rho * c);
                    }
                }
            }
        }
        (cost, gradient)
    }
}

impl Energy<'_> {
    /// λ_reg ½ Σ (P̂^h − 2 P̂^{h+1} + P̂^{h+2})², of the profiles themselves; adds its gradient.
    fn regulariser(&self, parameters: &[f64], gradient: &mut [f64]) -> f64 {
        let nodes = self.normal.geometry.nodes;
        let mean = &self.normal.mean;
        let weight = f64::from(SMOOTHNESS);
        let mut cost = 0.0;
        for base in 0..self.indices.bases.len() / nodes {
            for c in 0..3 {
                let at = |h: usize| (base * nodes + h) * 3 + c;
                let p = |h: usize| parameters[at(h)] + f64::from(mean[h][c]);
                for h in 0..nodes.saturating_sub(2) {
                    let bend = p(h) - 2.0 * p(h + 1) + p(h + 2);
                    cost += 0.5 * weight * bend * bend;
                    gradient[at(h)] += weight * bend;
                    gradient[at(h + 1)] -= 2.0 * weight * bend;
                    gradient[at(h + 2)] += weight * bend;
                }
            }
        }
        cost
    }
}

/// The parameters of a model.
pub(super) fn parameters_of(model: &Model) -> Vec<f64> {
    let profiles = model.bases.iter().flat_map(|node| [0, 1, 2].map(|c| f64::from(node[c])));
    let free = free_ratios(model.per_pixel);
    let ratios = model.mixtures.iter().flat_map(|mixture| mixture.ratios.into_iter().take(free));
    let ratios = ratios.map(|t| f64::from(t).clamp(EDGE, 1.0 - EDGE));
    profiles.chain(ratios).collect()
}

/// The model of some parameters, with the indices and K of `model`.
#[allow(clippy::cast_possible_truncation, reason = "the pairs are summed in single precision")]
pub(super) fn with_parameters(model: &Model, parameters: &[f64]) -> Model {
    let (profiles, ratios) = parameters.split_at(3 * model.bases.len());
    let bases = profiles.as_chunks::<3>().0.iter().map(|p| [p[0] as f32, p[1] as f32, p[2] as f32, 0.0]).collect();
    let free = free_ratios(model.per_pixel);
    let mixtures = model.mixtures.iter().enumerate().map(|(pixel, mixture)| {
        let t = &ratios[pixel * free..][..free];
        let mut ratios = [0.0; 5];
        match *t {
            [] => ratios[0] = 1.0,
            [t] => ratios[..2].copy_from_slice(&[t as f32, (1.0 - t) as f32]),
            _ => ratios.iter_mut().zip(t).for_each(|(ratio, t)| *ratio = *t as f32),
        }
        Mixture { ratios, ..*mixture }
    });
    Model { bases, mixtures: mixtures.collect(), palette: None, ..*model }
}

/// Ratios of a pixel that are parameters.
fn free_ratios(per_pixel: usize) -> usize {
    match per_pixel {
        1 => 0,
        2 => 1,
        more => more,
    }
}

/// λ_barr (−ln γt − ln(1 − γt)) of one ratio, and its slope.
fn barrier(t: f64) -> (f64, f64) {
    let value = -(GAMMA * t).ln() - (1.0 - GAMMA * t).ln();
    (BARRIER * value, BARRIER * (GAMMA / (1.0 - GAMMA * t) - 1.0 / t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::baseline::yatagawa2020::random;
    use crate::bssrdf::options::geometry;
    use crate::capture::{Capture, CaptureWriter, Overrides, Scalar, Sidecar};
    use crate::synthetic::unit;
    use rand::SeedableRng;
    use rand_pcg::Pcg64;
    use subsurf_decoder::bssrdf::Addressing;

    #[test]
    fn gradients_are_those_of_finite_differences() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npy");
        let sidecar = Sidecar { pitch_mm: 0.5, addressing: Addressing::Clamp, eta: 1.4, simulated: None };
        let writer = CaptureWriter { path: &path, size: [6, 5], radius: 2, scalar: Scalar::F32, sidecar: &sidecar };
        let rd = |n: u32| if unit(n) < 0.1 { f32::NAN } else { 0.1 + unit(n + 9_000) };
        writer.write(|sink| sink(&(0..6 * 5 * 25 * 3).map(rd).collect::<Vec<f32>>())).unwrap();
        let capture = Capture::open(&path, &Overrides::default()).unwrap();
        let normal = Normal::of(&capture, geometry(&capture, None).unwrap(), &()).unwrap();
        for per_pixel in [1, 2, 3, 5] {
            let model = random(&normal, per_pixel, 6, &mut Pcg64::seed_from_u64(3));
            let multipliers = Multipliers { lambda: (0..30).map(|n| f64::from(unit(n))).collect(), rho: 3.0 };
            let objective = Energy::new(&normal, &model, &multipliers);
            let mut at = parameters_of(&model);
            for (n, parameter) in (0..).zip(&mut at) {
                // Away from the start, where all ratios of a pixel are equal.
                *parameter += 0.1 * (f64::from(unit(n)) - 0.5);
            }
            let (_, gradient) = objective.evaluate(&at);
            for k in (0..at.len()).step_by(7) {
                let step = 1e-2;
                let cost = |shift: f64| {
                    let mut moved = at.clone();
                    moved[k] += shift;
                    objective.evaluate(&moved).0
                };
                let slope = (cost(step) - cost(-step)) / (2.0 * step);
                let scale = gradient.iter().map(|g| g.abs()).fold(0.0, f64::max);
                let error = (slope - gradient[k]).abs();
                assert!(error < 2e-3 * scale, "K = {per_pixel}, parameter {k}: {slope} against {}", gradient[k]);
            }
        }
    }
}
