//! The artist's model: two Gaussians along an axis.

use subsurf_decoder::kernel::layout::VARIANCES;

use crate::kernel::grid::{Grid, Separable};
use crate::kernel::profile::Radial;
use crate::math::lbfgs::{Bounds, Limits, Objective, minimise};

/// Share, variance of the near Gaussian in mm², and of the far one.
pub(in crate::kernel) type Two = [f64; 3];

/// Starts of the variances, as shares of the profile's own.
const STARTS: [[f64; 2]; 3] = [[0.01, 1.0], [0.001, 0.3], [0.05, 0.5]];
/// Shares of the near Gaussian and logarithms of variances by the profile's, at the bounds.
const BOUNDS: [[f64; 2]; 3] = [[0.0, 1.0], [-16.0, 4.0], [-16.0, 4.0]];

/// ∫_0^x of a normal distribution of variance τ.
pub(super) fn normal_to(x: f64, tau: f64) -> f64 {
    0.5 * libm::erf(x / (2.0 * tau).sqrt())
}

/// A = a_m(x) a_m(y) ‖R_d‖₁ with a_m = w G(τ_near) + (1 − w) G(τ_far) (section E).
pub(in crate::kernel) fn terms([w, near, far]: Two, energy: f64, grid: &Grid) -> Separable {
    let root = energy.sqrt();
    let a = grid.means(|x| root * (w * normal_to(x, near) + (1.0 - w) * normal_to(x, far)));
    Separable { grid: grid.clone(), terms: vec![(1.0, a)] }
}

/// The two Gaussians closest to the profile along an axis in the least-squares sense; the near one has the smaller variance.
pub(in crate::kernel) fn fit(radial: &Radial, grid: &Grid) -> Two {
    let energy = radial.energy();
    let problem = Problem { grid, widths: grid.widths(), target: grid.means(|x| radial.along_axis_to(x) / energy) };
    let variance = radial.variance_mm2();
    let shift = variance.ln();
    // Files have no variances beyond these.
    let [least, most] = VARIANCES.map(|variance| f64::from(variance).ln());
    let within = |log: f64| log.clamp(least, most);
    let bounds = |side: usize| {
        let log = |k: usize| within(BOUNDS[k][side] + shift);
        vec![BOUNDS[0][side], log(1), log(2)]
    };
    let bounds = Bounds { lower: bounds(0), upper: bounds(1) };
    let limits = Limits { relative_reduction: 1e-10, iterations: 300, is_stopped: &|| false };
    let found = STARTS.map(|[near, far]| {
        let start = vec![0.5, within(near.ln() + shift), within(far.ln() + shift)];
        let p = minimise(&problem, &bounds, start, &limits);
        (problem.evaluate(&p).0, p)
    });
    let best = found.iter().min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, p)| p).expect("there are three starts");
    let (w, near, far) = (best[0], best[1].exp(), best[2].exp());
    if near <= far { [w, near, far] } else { [1.0 - w, far, near] }
}

/// ∫ (a_p / ‖R_d‖₁ − a_m)² dx over its value without a_m, in w, ln τ_near and ln τ_far.
struct Problem<'a> {
    grid: &'a Grid,
    widths: Vec<f64>,
    target: Vec<f64>,
}

impl Objective for Problem<'_> {
    fn evaluate(&self, p: &[f64]) -> (f64, Vec<f64>) {
        let (w, tau) = (p[0], [p[1].exp(), p[2].exp()]);
        // Means in a cell, and their slopes by ln τ: ∫_0^x G is ½ erf(x / √(2τ)), whose slope is −½ x G(x).
        let means = tau.map(|tau| self.grid.means(|x| normal_to(x, tau)));
        let slopes = tau.map(|tau| {
            self.grid.means(|x| -0.5 * x * (-x * x / (2.0 * tau)).exp() / (std::f64::consts::TAU * tau).sqrt())
        });
        let (mut cost, mut slope, mut scale) = (0.0, vec![0.0; 3], 0.0);
        for (i, (target, h)) in self.target.iter().zip(&self.widths).enumerate() {
            let difference = w * means[0][i] + (1.0 - w) * means[1][i] - target;
            cost += h * difference * difference;
            scale += h * target * target;
            let by = [means[0][i] - means[1][i], w * slopes[0][i], (1.0 - w) * slopes[1][i]];
            for (slope, by) in slope.iter_mut().zip(by) {
                *slope += 2.0 * h * difference * by;
            }
        }
        (cost / scale, slope.into_iter().map(|slope| slope / scale).collect())
    }
}
