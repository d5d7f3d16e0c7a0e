//! Sums of Gaussians of the plane, the baseline.

use nalgebra::{DMatrix, DVector};

use super::two_gaussians::normal_to;
use crate::kernel::grid::{Grid, Separable};
use crate::kernel::profile::Radial;
use crate::math::lbfgs::{Bounds, Limits, Objective, minimise};

/// Logarithms of variances by the profile's own, at the bounds.
const BOUNDS: [f64; 2] = [-20.0, 4.0];

/// A_g = Σ w_i G(τ_i) of `terms` Gaussians, the closest in the Frobenius norm with ‖A_g‖₁ = ‖R_d‖₁ (d'Eon, Luebke and Enderton
/// 2007; eq. S.1). Weights may be negative.
///
/// Only variances are searched for: weights follow from them by linear equations. Fits of more Gaussians begin with those of
/// fewer.
pub(in crate::kernel) fn gaussians(radial: &Radial, grid: &Grid, terms: usize) -> Separable {
    let problem = Problem { radial, square: radial.square(), energy: radial.energy() };
    let [low, high] = BOUNDS.map(|bound| bound + radial.variance_mm2().ln());
    let limits = Limits { relative_reduction: 1e-10, iterations: 200, is_stopped: &|| false };
    let mut logs: Vec<f64> = Vec::new();
    for count in 1..=terms {
        let bounds = Bounds { lower: vec![low; count], upper: vec![high; count] };
        // One more: in the middle of every gap, and beyond both ends.
        let ends = [logs.first().map(|first| first - 1.5), logs.last().map(|last| last + 1.0)];
        let gaps = logs.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let mut more: Vec<f64> = ends.into_iter().flatten().chain(gaps).collect();
        if logs.is_empty() {
            more = (-5..=0).map(|k| high - BOUNDS[1] + 1.5 * f64::from(k)).collect();
        }
        let tried = more.iter().map(|log| {
            let start = logs.iter().copied().chain([log.clamp(low, high)]).collect();
            let found = minimise(&problem, &bounds, start, &limits);
            (problem.evaluate(&found).0, found)
        });
        logs = tried.min_by(|a, b| a.0.total_cmp(&b.0)).expect("there is a place for one more").1;
        logs.sort_by(f64::total_cmp);
    }
    let taus: Vec<f64> = logs.iter().map(|log| log.exp()).collect();
    let mut order: Vec<(f64, f64)> = problem.weights(&taus).into_iter().zip(taus).collect();
    order.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let term = |(w, tau): (f64, f64)| (w.signum(), grid.means(|x| w.abs().sqrt() * normal_to(x, tau)));
    Separable { grid: grid.clone(), terms: order.into_iter().map(term).collect() }
}

/// ‖R_d − A_g‖² / ‖R_d‖² in ln τ.
struct Problem<'a> {
    radial: &'a Radial,
    square: f64,
    energy: f64,
}

impl Problem<'_> {
    /// ⟨R_d, G(τ)⟩ in mm⁻², and its slope by ln τ: the share of G's light within a disc is 1 − exp(−r²/2τ).
    fn with_profile(&self, tau: f64) -> (f64, f64) {
        let disc = |(r, fall): (f64, f64)| {
            let u = r * r / (2.0 * tau);
            (fall * -(-u).exp_m1(), -fall * u * (-u).exp())
        };
        self.radial.discs().map(disc).fold((0.0, 0.0), |(value, slope), (v, s)| (value + v, slope + s))
    }

    /// w of least error whose sum is ‖R_d‖₁: the conditions of Lagrange, ⟨G_i, G_j⟩ = 1 / (2π (τ_i + τ_j)).
    fn weights(&self, taus: &[f64]) -> Vec<f64> {
        let n = taus.len();
        // Scaled to a diagonal of 1, with a trace of a ridge: equal variances share a weight.
        let scale: Vec<f64> = taus.iter().map(|tau| (2.0 * std::f64::consts::TAU * tau).sqrt()).collect();
        let mut system = DMatrix::zeros(n + 1, n + 1);
        let mut right = DVector::zeros(n + 1);
        for i in 0..n {
            for j in 0..n {
                system[(i, j)] = scale[i] * scale[j] / (std::f64::consts::TAU * (taus[i] + taus[j]));
            }
            system[(i, i)] += 1e-10;
            system[(i, n)] = scale[i] / scale[0];
            system[(n, i)] = scale[i] / scale[0];
            right[i] = scale[i] * self.with_profile(taus[i]).0;
        }
        right[n] = self.energy / scale[0];
        let solved = system.lu().solve(&right).unwrap_or(right);
        (0..n).map(|i| solved[i] * scale[i]).collect()
    }
}

impl Objective for Problem<'_> {
    fn evaluate(&self, logs: &[f64]) -> (f64, Vec<f64>) {
        let taus: Vec<f64> = logs.iter().map(|log| log.exp()).collect();
        let w = self.weights(&taus);
        let (mut cost, mut slopes) = (self.square, Vec::with_capacity(taus.len()));
        for (i, tau) in taus.iter().enumerate() {
            let (value, mut slope) = self.with_profile(*tau);
            cost -= 2.0 * w[i] * value;
            slope *= -2.0 * w[i];
            for (j, other) in taus.iter().enumerate() {
                let sum = tau + other;
                let product = 1.0 / (std::f64::consts::TAU * sum);
                cost += w[i] * w[j] * product;
                slope -= 2.0 * w[i] * w[j] * product * tau / sum;
            }
            // Weights are best as they are: their own slopes are 0 along the constraint.
            slopes.push(slope / self.square);
        }
        (cost / self.square, slopes)
    }
}
