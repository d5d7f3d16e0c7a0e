//! Weights for given standard deviations: non-negative least squares.
//!
//! Each round minimises a majorant of the form, in which pixels are apart, by coordinate descent over the few Gaussians of each
//! pixel; rounds are accelerated (Beck and Teboulle 2009, FISTA) and start anew where that leads uphill (O'Donoghue and Candès
//! 2015).

use super::channel::{Channel, Form};
use crate::progress::Progress;

/// Rounds of a whole fit: costs change in the fifth digit then.
pub(super) const ROUNDS: usize = 300;
/// Sweeps over the Gaussians of a pixel.
const SWEEPS: usize = 8;

/// Weights of the least cost, shape `[h][pixel]`, from `start` or from even ones.
pub(super) fn solve(
    channel: &Channel<'_>,
    sigmas: &[f64],
    start: Option<Vec<Vec<f32>>>,
    rounds: usize,
    progress: &dyn Progress,
) -> Vec<Vec<f32>> {
    solve_form(&channel.form(sigmas), channel.pixels(), start, rounds, progress)
}

/// The same for a form that is there already.
pub(super) fn solve_form(
    form: &Form<'_>,
    pixels: usize,
    start: Option<Vec<Vec<f32>>>,
    rounds: usize,
    progress: &dyn Progress,
) -> Vec<Vec<f32>> {
    let count = form.gaussians();
    let matrix = form.majorant();
    let mut weights = start.unwrap_or_else(|| vec![vec![0.0; pixels]; count]);
    let mut ahead = weights.clone();
    let mut momentum = 1.0_f32;
    for _ in 0..rounds {
        if progress.stopped() {
            break;
        }
        let gradient = form.at(&ahead).gradient;
        let next = step(&matrix, &ahead, &gradient);
        // Uphill: the gradient where it was ahead points along the last move.
        let uphill: f64 = (0..count)
            .map(|h| (0..pixels).map(|i| f64::from(gradient[h][i] * (next[h][i] - weights[h][i]))).sum::<f64>())
            .sum();
        let grown = 0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt());
        let factor = if uphill > 0.0 { 0.0 } else { (momentum - 1.0) / grown };
        momentum = if uphill > 0.0 { 1.0 } else { grown };
        for h in 0..count {
            for i in 0..pixels {
                ahead[h][i] = next[h][i] + factor * (next[h][i] - weights[h][i]);
            }
        }
        weights = next;
    }
    weights
}

/// Minimum over z ≥ 0 of g · (z − y) + ½ (z − y)^T M (z − y) for every pixel.
fn step(matrix: &[Vec<f64>], from: &[Vec<f32>], gradient: &[Vec<f32>]) -> Vec<Vec<f32>> {
    let count = matrix.len();
    let mut next = from.to_vec();
    let (mut z, mut c) = (vec![0.0; count], vec![0.0; count]);
    for pixel in 0..from[0].len() {
        for h in 0..count {
            // c = M y − g.
            c[h] = (0..count).map(|k| matrix[h][k] * f64::from(from[k][pixel])).sum::<f64>()
                - f64::from(gradient[h][pixel]);
            z[h] = f64::from(from[h][pixel]).max(0.0);
        }
        for _ in 0..SWEEPS {
            for h in 0..count {
                let others: f64 = (0..count).filter(|k| *k != h).map(|k| matrix[h][k] * z[k]).sum();
                z[h] = ((c[h] - others) / matrix[h][h]).max(0.0);
            }
        }
        #[allow(clippy::cast_possible_truncation, reason = "single precision")]
        next.iter_mut().zip(&z).for_each(|(next, z)| next[pixel] = *z as f32);
    }
    next
}
