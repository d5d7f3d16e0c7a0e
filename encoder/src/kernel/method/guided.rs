//! The best separable profile under a guide function.

use crate::kernel::grid::{Grid, Separable};
use crate::kernel::profile::Radial;
use crate::math::lbfgs::{Bounds, Limits, Objective, minimise};

/// b of the guide function, with x and y in −1 .. 1 (section D).
const SUPPRESSION: f64 = 50.0;
/// Share of the light beyond x, y = ±1: what is seen of a profile lies within.
const BEYOND: f64 = 0.1;
/// Numbers of even cells along half an axis, one search after the other.
///
/// More would not see more: the guide function vanishes towards the axes, within a seventh of the radius. There, ever narrower
/// cells would take up all energy that is left over, at no cost.
const LEVELS: [usize; 3] = [8, 16, 32];
/// Least change of cost by an iteration that is worth the next.
const REDUCTION: f64 = 1e-9;
/// Iterations on each grid.
const ITERATIONS: u64 = 400;

/// Γ(x, y; k) = (x² + y²)^{k/2} (1 − e^{−bx²}) (1 − e^{−by²}) (eq. S.9).
fn guide(x: f64, y: f64, k: f64) -> f64 {
    let suppressed = |x: f64| 1.0 - (-SUPPRESSION * x * x).exp();
    (x * x + y * y).powf(0.5 * k) * suppressed(x) * suppressed(y)
}

/// a_s = argmin ∫∫ Γ (R_d − a(x) a(y))² with ‖R_d‖₁ = ‖a‖₁² (eq. S.7), from near scattering (k = 0) to far (k = 4).
///
/// a = a_p f is the profile along an axis times a factor: so it keeps its peak, which even cells do not resolve. f = e^q is positive
/// and a is scaled to its energy, whatever q is, so that the search is free. It begins with q = 0, and on every finer grid with
/// what the last found. Beyond x = 1 the factor stays as it is there.
///
/// The search keeps ‖a‖₁ within x = 1; scaling to ‖R_d‖₁ over the whole axis comes after it, and changes that. On skin1 with 65 taps,
/// weights are closest to a_p's at k = 0 (L1 distance 0.11; 0.13 to 0.14 at k = 1.55, which section D calls neutral; 0.22 to 0.25 at
/// k = 4), and both the middle (0.78 of a_p's at k = 0, 1.20 at k = 4) and the far end gain with k.
pub(in crate::kernel) fn guided(radial: &Radial, grid: &Grid, k: f64) -> Separable {
    let radius = radial.radius_of(BEYOND);
    let mut level = Grid::even(radius, LEVELS[0]);
    let mut q = vec![0.0; LEVELS[0]];
    for cells in LEVELS {
        let finer = Grid::even(radius, cells);
        q = finer.middles().iter().map(|x| interpolated(&level.middles(), &q, *x)).collect();
        level = finer;
        let problem = Problem::new(radial, &level, k);
        let free = Bounds { lower: vec![f64::NEG_INFINITY; cells], upper: vec![f64::INFINITY; cells] };
        let limits = Limits { relative_reduction: REDUCTION, iterations: ITERATIONS, is_stopped: &|| false };
        q = minimise(&problem, &free, q, &limits);
    }
    let along = grid.means(|x| radial.along_axis_to(x));
    let middles = level.middles();
    let largest = q.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let factor = |x: &f64| (interpolated(&middles, &q, *x) - largest).exp();
    let a = along.iter().zip(&grid.middles()).map(|(a, x)| a * factor(x)).collect();
    let mut separable = Separable { grid: grid.clone(), terms: vec![(1.0, a)] };
    separable.rescale(radial.energy());
    separable
}

/// Value at `x` on the lines between points of ascending `xs`; that of the outermost ones beyond them.
fn interpolated(xs: &[f64], values: &[f64], x: f64) -> f64 {
    let right = xs.partition_point(|known| *known < x).clamp(1, xs.len() - 1);
    let (a, b) = (xs[right - 1], xs[right]);
    values[right - 1] + (values[right] - values[right - 1]) * ((x - a) / (b - a)).clamp(0.0, 1.0)
}

/// Eq. S.7 on a grid, in q.
struct Problem {
    /// ‖a‖₁ within the grid: that of a_p / √‖R_d‖₁.
    norm: f64,
    /// h of the cells.
    widths: Vec<f64>,
    /// a_p in mm⁻¹.
    along: Vec<f64>,
    /// Γ h_i h_j `[i][j]`, over Σ Γ h_i h_j R_d².
    guide: Vec<f64>,
    /// R_d `[i][j]` in mm⁻².
    plane: Vec<f64>,
}

impl Problem {
    fn new(radial: &Radial, grid: &Grid, k: f64) -> Self {
        let (n, widths, middles, plane) = (grid.cells(), grid.widths(), grid.middles(), grid.plane(radial));
        let at = |i: usize, j: usize| {
            let [x, y] = [i, j].map(|i| middles[i] / grid.radius_mm());
            guide(x, y, k) * widths[i] * widths[j]
        };
        let mut guide: Vec<f64> = (0..n * n).map(|cell| at(cell / n, cell % n)).collect();
        let total: f64 = guide.iter().zip(&plane).map(|(g, r)| g * r * r).sum();
        guide.iter_mut().for_each(|g| *g /= total);
        let along = grid.means(|x| radial.along_axis_to(x));
        let norm = 2.0 * radial.along_axis_to(grid.radius_mm()) / radial.energy().sqrt();
        Self { norm, widths, along, guide, plane }
    }

    /// a = ‖a‖₁ a_p e^q / ‖a_p e^q‖₁ in mm⁻¹ of the cells.
    fn profile(&self, q: &[f64]) -> Vec<f64> {
        // The largest factor is 1, so that none overflows.
        let largest = q.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let a: Vec<f64> = q.iter().zip(&self.along).map(|(q, along)| along * (q - largest).exp()).collect();
        let own = 2.0 * a.iter().zip(&self.widths).map(|(a, h)| a * h).sum::<f64>();
        a.iter().map(|a| self.norm * a / own).collect()
    }
}

impl Objective for Problem {
    fn evaluate(&self, q: &[f64]) -> (f64, Vec<f64>) {
        let n = q.len();
        let a = self.profile(q);
        let (mut cost, mut by_a) = (0.0, vec![0.0; n]);
        for i in 0..n {
            let mut sum = 0.0;
            for j in 0..n {
                let difference = a[i] * a[j] - self.plane[i * n + j];
                let weighted = self.guide[i * n + j] * difference;
                cost += weighted * difference;
                sum += weighted * a[j];
            }
            // ∂/∂a_i of both Γ_ij and Γ_ji.
            by_a[i] = 4.0 * sum;
        }
        // Σ 2 h a = ‖a‖₁: ∂a_i/∂q_j = a_i δ_ij − a_i 2 h_j a_j / ‖a‖₁.
        let mean: f64 = by_a.iter().zip(&a).map(|(slope, a)| slope * a).sum::<f64>() / self.norm;
        let slope = |j: usize| a[j] * (by_a[j] - 2.0 * self.widths[j] * mean);
        (cost, (0..n).map(slope).collect())
    }
}
