//! Every kernel g_l g_m as a sum of the same Gaussians.

#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "counts and widths are small")]

use nalgebra::{DMatrix, DVector};
use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_decoder::bssrdf::basis::BasisSize;

use super::radial::Radial;

/// Narrowest σ to begin with, in pixels.
const NARROWEST: f64 = 0.45;
/// Widest σ to begin with, as a share of the window radius.
const WIDEST: f64 = 0.45;
/// Share of the largest value of a kernel that errors are taken relative to at least.
const FLOOR: f64 = 0.02;
/// Regularisation that keeps weights of similar Gaussians from growing against each other: half floats have to hold their sums.
const RIDGE: f64 = 1e-4;
/// Rounds of the search for better widths.
const ROUNDS: usize = 12;

/// Offsets of one length.
struct Ring {
    /// Length in pixels.
    r: f64,
    /// Number of offsets.
    count: f64,
}

/// Logarithms of widths σ_a in pixels, shape `[A]`, and weights in mm⁻², shape `[L][L][A]`, for offsets of whole pixels in the window.
pub(super) fn fit(header: &BssrdfHeader, radial: &Radial, size: BasisSize) -> (Vec<f64>, Vec<[f64; 3]>) {
    let rings = rings(header);
    let kernels = kernels(&rings, radial, size.terms);
    let radius = f64::from(header.window_radius.max(1));
    // Widths by equal factors, then each moved as long as that helps.
    let (low, high) = (NARROWEST, (WIDEST * radius).max(2.0 * NARROWEST));
    let part = |a: usize| if size.gaussians > 1 { a as f64 / (size.gaussians - 1) as f64 } else { 0.5 };
    let mut logs: Vec<f64> = (0..size.gaussians).map(|a| low.ln() + part(a) * (high / low).ln()).collect();
    let mut loss = solve(&rings, &kernels, &logs).1;
    let mut step = 0.3;
    for _ in 0..ROUNDS {
        let mut moved = false;
        for a in 0..logs.len() {
            for direction in [step, -step] {
                let mut tried = logs.clone();
                tried[a] = (tried[a] + direction).clamp(0.25_f64.ln(), radius.max(1.0).ln());
                let found = solve(&rings, &kernels, &tried).1;
                if found < loss {
                    (loss, logs, moved) = (found, tried, true);
                }
            }
        }
        if !moved {
            step *= 0.5;
        }
    }
    logs.sort_by(f64::total_cmp);
    let (weights, _) = solve(&rings, &kernels, &logs);
    (logs, weights)
}

/// Rings of the window within r_max, by rising length.
fn rings(header: &BssrdfHeader) -> Vec<Ring> {
    let radius = i32::from(header.window_radius);
    let r_max = f64::from(header.r_max_mm / header.pitch_mm);
    let mut squares: Vec<i32> =
        (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| dx * dx + dy * dy)).collect();
    squares.sort_unstable();
    let rings = squares.chunk_by(|a, b| a == b);
    let rings = rings.map(|ring| Ring { r: f64::from(ring[0]).sqrt(), count: ring.len() as f64 });
    rings.filter(|ring| ring.r <= r_max).collect()
}

/// One kernel g_l g_m of a channel at every ring, and the weight of its errors there.
struct Kernel {
    values: Vec<f64>,
    importance: Vec<f64>,
}

/// Kernels of all l, m and channels, shape `[l][m][c]`.
fn kernels(rings: &[Ring], radial: &Radial, terms: usize) -> Vec<Kernel> {
    let all = (0..terms).flat_map(|l| (0..terms).flat_map(move |m| (0..3).map(move |c| (l, m, c))));
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs())).max(1e-30);
    let mut kernels: Vec<Kernel> = all
        .map(|(l, m, c)| {
            let values: Vec<f64> = rings.iter().map(|ring| radial.at(l, ring.r, c) * radial.at(m, ring.r, c)).collect();
            let floor = FLOOR * largest(&values);
            let importance = rings.iter().zip(&values).map(|(ring, value)| ring.count / (floor + value.abs()).powi(2));
            Kernel { importance: importance.collect(), values }
        })
        .collect();
    // Errors of all kernels are compared by what they are a share of: the light that the first one carries.
    for c in 0..3 {
        let carried =
            |kernel: &Kernel| rings.iter().zip(&kernel.values).map(|(ring, v)| ring.count * v.abs()).sum::<f64>();
        let first = carried(&kernels[c]);
        for kernel in kernels.iter_mut().skip(c).step_by(3) {
            // Where the first one is black, all are.
            let share = if first > 0.0 { (carried(kernel) / first).powi(2) } else { 1.0 };
            kernel.importance.iter_mut().for_each(|importance| *importance *= share);
        }
    }
    kernels
}

/// Best weights for given logarithms of widths, shape `[l][m][a]`, and the error that is left.
///
/// Least squares with each kernel's sum over the window held: no light is lost or made.
fn solve(rings: &[Ring], kernels: &[Kernel], logs: &[f64]) -> (Vec<[f64; 3]>, f64) {
    let count = logs.len();
    let shapes: Vec<Vec<f64>> = logs.iter().map(|log| shape(rings, log.exp())).collect();
    let mut weights = vec![[0.0; 3]; kernels.len() / 3 * count];
    let mut loss = 0.0;
    for (number, kernel) in kernels.iter().enumerate() {
        // Stationary point of the error with a multiplier for Σ_a w_a = Σ_r K(r).
        let mut matrix = DMatrix::zeros(count + 1, count + 1);
        let mut right = DVector::zeros(count + 1);
        for a in 0..count {
            for b in 0..count {
                matrix[(a, b)] = dot3(&kernel.importance, &shapes[a], &shapes[b]);
            }
            matrix[(a, a)] *= 1.0 + RIDGE;
            right[a] = dot3(&kernel.importance, &shapes[a], &kernel.values);
            matrix[(a, count)] = 1.0;
            matrix[(count, a)] = 1.0;
        }
        right[count] = rings.iter().zip(&kernel.values).map(|(ring, value)| ring.count * value).sum();
        let solved = matrix.lu().solve(&right).unwrap_or_else(|| DVector::zeros(count + 1));
        for (k, value) in kernel.values.iter().enumerate() {
            let model: f64 = (0..count).map(|a| solved[a] * shapes[a][k]).sum();
            loss += kernel.importance[k] * (model - value).powi(2);
        }
        for a in 0..count {
            weights[number / 3 * count + a][number % 3] = solved[a];
        }
    }
    (weights, loss)
}

/// Sum of the products of three vectors.
fn dot3(a: &[f64], b: &[f64], c: &[f64]) -> f64 {
    a.iter().zip(b).zip(c).map(|((a, b), c)| a * b * c).sum()
}

/// Gaussian of σ pixels at every ring, of sum 1 over all pixels of the plane.
fn shape(rings: &[Ring], sigma: f64) -> Vec<f64> {
    let tail = (8.0 * sigma).ceil() as i32 + 1;
    let line: f64 = (-tail..=tail).map(|x| (-0.5 * (f64::from(x) / sigma).powi(2)).exp()).sum();
    rings.iter().map(|ring| (-0.5 * (ring.r / sigma).powi(2)).exp() / (line * line)).collect()
}
