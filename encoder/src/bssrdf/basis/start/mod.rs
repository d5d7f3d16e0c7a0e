//! Where the fit starts: radial functions of a singular value decomposition, each product of two as a sum of Gaussians.

mod gaussians;
mod radial;

use nalgebra::{Cholesky, DMatrix, DVector};
use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_decoder::bssrdf::basis::BasisSize;

use self::radial::Radial;
use super::params::{Channel, Params};
use super::patch::Patch;

/// Regularisation of the factors, as a share of the diagonal.
const RIDGE: f64 = 1e-9;

/// Numbers to begin with.
pub(super) fn start(header: &BssrdfHeader, patches: &[Patch], size: BasisSize) -> Params {
    let radial = Radial::of(header, patches, size.terms);
    let (log_sigmas, weights) = gaussians::fit(header, &radial, size);
    let area = f64::from(header.pitch_mm) * f64::from(header.pitch_mm);
    let channels = [0, 1, 2].map(|c| {
        let pairs = (0..size.terms).flat_map(|l| (l..size.terms).map(move |m| l * size.terms + m));
        let of_pair = |pair: usize| weights[pair * size.gaussians..][..size.gaussians].iter().map(|rgb| rgb[c] * area);
        Channel {
            d: (0..size.terms).flat_map(|l| factors(patches, &radial.coefficients[c][l], c)).collect(),
            w: pairs.flat_map(of_pair).collect(),
        }
    });
    let mut params = Params { size, log_sigmas, channels };
    params.keep_widths_in_range();
    params
}

/// Factors d_h of the nodes with which Σ_h d_h f_h is closest to coefficients of the pixels that the fit starts from, by least squares.
fn factors(patches: &[Patch], coefficients: &[f64], c: usize) -> Vec<f64> {
    let nodes = patches[0].f[c].len();
    let mut matrix = DMatrix::zeros(nodes, nodes);
    let mut right = DVector::zeros(nodes);
    let mut rest = coefficients;
    for patch in patches {
        let (own, others) = rest.split_at(patch.started.len());
        rest = others;
        for (i, a) in patch.f[c].iter().enumerate() {
            let of = |f: &[f32], sample: usize| f64::from(f[sample]);
            let started = || patch.started.iter();
            right[i] += started().zip(own).map(|(sample, value)| of(a, *sample) * value).sum::<f64>();
            for (j, b) in patch.f[c].iter().enumerate().skip(i) {
                matrix[(i, j)] += started().map(|sample| of(a, *sample) * of(b, *sample)).sum::<f64>();
                matrix[(j, i)] = matrix[(i, j)];
            }
        }
    }
    for i in 0..nodes {
        // Nodes that say nothing get nothing.
        matrix[(i, i)] = if matrix[(i, i)] > 0.0 { matrix[(i, i)] * (1.0 + RIDGE) } else { 1.0 };
    }
    let solved = Cholesky::new(matrix).map(|cholesky| cholesky.solve(&right));
    solved.map_or_else(|| vec![0.0; nodes], |solved| solved.as_slice().to_vec())
}
