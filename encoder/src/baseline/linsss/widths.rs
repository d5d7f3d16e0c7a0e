//! Standard deviations: from the best of some geometric series, L-BFGS-B on their logarithms.
//!
//! At weights of least cost, the slope of the cost along a standard deviation is that with the weights held (envelope theorem).

use std::sync::Mutex;

use super::channel::Channel;
use super::weights::{solve, solve_form};
use crate::math::lbfgs::{Bounds, Limits, Objective, minimise};
use crate::progress::Progress;

/// Narrowest Gaussian of a start, in pixels.
const NARROWEST: f64 = 0.5;
/// Widest Gaussian of a start, as shares of the window's radius.
const WIDEST: [f64; 3] = [0.25, 0.37, 0.5];
/// Bounds: below, one pixel sees nothing of the next; above, the window cuts off too much.
const LEAST: f64 = 0.3;
const MOST: f64 = 0.55;
/// Rounds of weights for a start, and from one step to the next.
const FIRST_ROUNDS: usize = 60;
const ROUNDS: usize = 30;
/// Steps of the descent at most.
const STEPS: u64 = 12;
/// A step that lowers the cost by less than this share is the last.
const LEAST_GAIN: f64 = 1e-3;
/// Difference of logarithms from which slopes are taken.
const DIFFERENCE: f64 = 1e-2;

/// Standard deviations in pixels, by rising width.
pub(super) fn descend(channel: &Channel<'_>, gaussians: usize, progress: &dyn Progress) -> Vec<f64> {
    #[allow(clippy::cast_precision_loss, reason = "a window radius is below 1,024")]
    let radius = channel.sums.radius as f64;
    let series = |widest: f64| -> Vec<f64> {
        let ratio = (widest * radius).max(1.5) / NARROWEST;
        #[allow(clippy::cast_precision_loss, reason = "at most 8 Gaussians")]
        let place = |h: usize| if gaussians == 1 { 0.5 } else { h as f64 / (gaussians - 1) as f64 };
        (0..gaussians).map(|h| NARROWEST * ratio.powf(place(h))).collect()
    };
    let tried = WIDEST.map(|widest| {
        let sigmas = series(widest);
        let weights = solve(channel, &sigmas, None, FIRST_ROUNDS, progress);
        (channel.form(&sigmas).at(&weights).cost, sigmas, weights)
    });
    let best = tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    let (_, sigmas, weights) = best.expect("there are several starts");
    let cost = Cost { channel, weights: Mutex::new(weights), progress };
    let bounds = Bounds { lower: vec![LEAST.ln(); gaussians], upper: vec![(MOST * radius).max(2.0).ln(); gaussians] };
    let is_stopped = || progress.stopped();
    let limits = Limits { relative_reduction: LEAST_GAIN, iterations: STEPS, is_stopped: &is_stopped };
    let start = sigmas.iter().map(|sigma| sigma.ln().clamp(bounds.lower[0], bounds.upper[0])).collect();
    let mut found: Vec<f64> = minimise(&cost, &bounds, start, &limits).into_iter().map(f64::exp).collect();
    found.sort_by(f64::total_cmp);
    found
}

/// Least cost of the weights, as a function of the logarithms of the standard deviations.
struct Cost<'a> {
    channel: &'a Channel<'a>,
    /// Weights of the last evaluation, where the next one starts.
    weights: Mutex<Vec<Vec<f32>>>,
    progress: &'a dyn Progress,
}

impl Objective for Cost<'_> {
    fn evaluate(&self, logarithms: &[f64]) -> (f64, Vec<f64>) {
        let sigmas = |logarithms: &[f64]| -> Vec<f64> { logarithms.iter().map(|ln| ln.exp()).collect() };
        let form = self.channel.form(&sigmas(logarithms));
        let mut kept = self.weights.lock().expect("no evaluation panics");
        *kept = solve_form(&form, self.channel.pixels(), Some(kept.clone()), ROUNDS, self.progress);
        let slope = |h: usize| {
            let at = |step: f64| {
                let mut moved = logarithms.to_vec();
                moved[h] += step;
                self.channel.form(&sigmas(&moved)).at(&kept).cost
            };
            (at(DIFFERENCE) - at(-DIFFERENCE)) / (2.0 * DIFFERENCE)
        };
        (form.at(&kept).cost, (0..logarithms.len()).map(slope).collect())
    }
}
