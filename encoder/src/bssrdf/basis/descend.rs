//! Levenberg-Marquardt: steps of least squares, shorter where they do not help (Marquardt 1963).

use nalgebra::{Cholesky, DMatrix, DVector};

use super::normal::{Normal, normals};
use super::params::Params;
use super::patch::Patch;
use super::render::loss;
use crate::progress::Progress;

/// λ to begin with, and its factors after a step that helped and after one that did not.
const LAMBDA: f64 = 1e-3;
const SHORTER: f64 = 0.25;
const LONGER: f64 = 5.0;
/// Attempts at one step.
const ATTEMPTS: usize = 6;
/// Damping by the largest of the diagonal, as a share of that by each unknown's own: what next to nothing depends on stays.
const FLOOR: f64 = 1e-6;
/// Share of the loss that a step has to take away for another to follow.
const LEAST_GAIN: f64 = 0.01;

/// Moves all numbers by at most `steps` steps, each of which comes closer to the targets; ends early when asked to.
pub(super) fn descend(params: &mut Params, patches: &[Patch], steps: usize, progress: &dyn Progress) {
    if steps == 0 {
        return;
    }
    let name = format!("fitting a separable basis, {} terms, {} Gaussians", params.size.terms, params.size.gaussians);
    progress.begin(&name, steps as u64);
    let mut lambda = LAMBDA;
    let mut reached = loss(params, patches);
    for done in 0..steps {
        let normals = normals(params, patches);
        let mut helped = None;
        for _ in 0..ATTEMPTS {
            let tried = step(params, &normals, lambda);
            let found = tried.as_ref().map_or(f64::INFINITY, |tried| loss(tried, patches));
            if let Some(tried) = tried.filter(|_| found < reached) {
                helped = Some((tried, found));
                lambda *= SHORTER;
                break;
            }
            lambda *= LONGER;
        }
        let gain = helped.as_ref().map_or(0.0, |(_, found)| 1.0 - found / reached);
        if let Some(helped) = helped {
            (*params, reached) = helped;
        }
        if gain < LEAST_GAIN || progress.stopped() {
            progress.advance((steps - done) as u64);
            return;
        }
        progress.advance(1);
    }
}

/// Equations of one channel, unknowns divided by the roots of the diagonal, and solved up to the widths.
struct Solved {
    /// 1 / √diagonal of the channel's unknowns; 0 for those that nothing depends on.
    inverse: DVector<f64>,
    /// N⁻¹ g and N⁻¹ B of scaled unknowns.
    alone: DVector<f64>,
    by_widths: DMatrix<f64>,
}

/// Numbers after one step: (N + λ D) δ = g, D the diagonal of N and a little of its largest, with a block for each channel and a border for the widths that they share.
fn step(params: &Params, normals: &[Normal; 3], lambda: f64) -> Option<Params> {
    let (own, widths) = (params.of_channel(), params.size.gaussians);
    let mut border = DMatrix::zeros(widths, widths);
    let mut right = DVector::zeros(widths);
    for Normal(all) in normals {
        border += all.view((own, own), (widths, widths));
        right += all.view((own, own + widths), (widths, 1)).column(0);
    }
    for a in 0..widths {
        border[(a, a)] = border[(a, a)] * (1.0 + lambda) + f64::MIN_POSITIVE;
    }
    let mut solved = Vec::new();
    for Normal(all) in normals {
        let root = |k: usize| {
            let root = all[(k, k)].sqrt();
            if root > 0.0 { 1.0 / root } else { 0.0 }
        };
        let inverse = DVector::from_iterator(own, (0..own).map(root));
        let mut matrix = DMatrix::from_fn(own, own, |i, j| all[(i, j)] * inverse[i] * inverse[j]);
        let most = (0..own).map(|k| all[(k, k)]).fold(0.0, f64::max);
        for k in 0..own {
            matrix[(k, k)] = 1.0 + lambda * (1.0 + FLOOR * most * inverse[k].powi(2));
        }
        let cholesky = Cholesky::new(matrix)?;
        let alone = cholesky.solve(&DVector::from_fn(own, |i, _| all[(i, own + widths)] * inverse[i]));
        let beside = DMatrix::from_fn(own, widths, |i, a| all[(i, own + a)] * inverse[i]);
        let by_widths = cholesky.solve(&beside);
        border -= beside.tr_mul(&by_widths);
        right -= beside.tr_mul(&alone);
        solved.push(Solved { inverse, alone, by_widths });
    }
    let of_widths = Cholesky::new(border)?.solve(&right);
    let of_channel = |c: usize| {
        let Solved { inverse, alone, by_widths, .. } = &solved[c];
        (alone - by_widths * &of_widths).component_mul(inverse).as_slice().to_vec()
    };
    let channels = [0, 1, 2].map(of_channel);
    let is_finite = channels.iter().flatten().chain(of_widths.as_slice()).all(|value| value.is_finite());
    is_finite.then(|| params.stepped(&channels, of_widths.as_slice()))
}
