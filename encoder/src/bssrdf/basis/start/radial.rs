//! f_x(r) ≈ Σ_l c_l(x) g_l(r): the radial functions that all pixels share, by a weighted singular value decomposition.

use nalgebra::{DMatrix, SymmetricEigen};
use subsurf_decoder::bssrdf::BssrdfHeader;

use crate::bssrdf::basis::patch::{Patch, RADII};
use crate::math::parallel;

/// Least weight of a radius in pixels: weights are shares of the area, max(r, this), so that light near the beam counts.
const LEAST_RADIUS: f64 = 0.3;
/// Pixels whose products are summed apart from those of others.
const BLOCK: usize = 1024;

/// Radial functions of a material, and their coefficients.
pub(super) struct Radial {
    /// Coefficients c_l of the pixels of all patches that the fit starts from, at most 1; shape `[c][L][pixel]`.
    pub(super) coefficients: [Vec<Vec<f64>>; 3],
    /// Functions g_l in mm⁻¹, shape `[c][L][radius]`.
    functions: [Vec<Vec<f64>>; 3],
    /// Pixels from one radius to the next.
    step: f64,
}

#[allow(clippy::cast_precision_loss, reason = "64 radii")]
fn float(k: usize) -> f64 {
    k as f64
}

impl Radial {
    /// Decomposition into `terms` radial functions.
    pub(super) fn of(header: &BssrdfHeader, patches: &[Patch], terms: usize) -> Self {
        let step = f64::from(header.r_max_mm / header.pitch_mm) / float(RADII - 1);
        let weight: Vec<f64> = (0..RADII).map(|k| (float(k) * step).max(LEAST_RADIUS)).collect();
        let samples: Vec<&[[f32; 3]]> = patches.iter().flat_map(|patch| patch.profiles.chunks(RADII)).collect();
        let mut radial = Self { coefficients: [const { Vec::new() }; 3], functions: [const { Vec::new() }; 3], step };
        for c in 0..3 {
            // Eigenvectors of Σ_x (√w f_x)(√w f_x)ᵀ, largest eigenvalues first.
            let eigen = SymmetricEigen::new(gram(&samples, &weight, c));
            let mut order: Vec<usize> = (0..RADII).collect();
            order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
            for &column in order.iter().take(terms) {
                let vector = eigen.eigenvectors.column(column);
                // The sign is arbitrary; with this one the first function is a mean profile.
                let sign = vector.sum().signum();
                let g: Vec<f64> = (0..RADII).map(|k| sign * vector[k] / weight[k].sqrt()).collect();
                let of_pixel = |f: &[[f32; 3]]| (0..RADII).map(|k| weight[k] * f64::from(f[k][c]) * g[k]).sum();
                let of_pixels: Vec<f64> = parallel::map(samples.len(), |x| of_pixel(samples[x]));
                let scale = of_pixels.iter().fold(0.0_f64, |most, value| most.max(value.abs())).max(1e-30);
                radial.functions[c].push(g.iter().map(|g| g * scale).collect());
                radial.coefficients[c].push(of_pixels.iter().map(|value| value / scale).collect());
            }
        }
        radial
    }

    /// Value g_l(r) of a channel, r in pixels, at most r_max.
    pub(super) fn at(&self, l: usize, r: f64, c: usize) -> f64 {
        let position = (r / self.step).min(float(RADII - 1));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the radii")]
        let k = (position as usize).min(RADII - 2);
        let w = position - float(k);
        let g = &self.functions[c][l];
        (1.0 - w) * g[k] + w * g[k + 1]
    }
}

/// Gram matrix Σ_x w_k^½ f_x(r_k) f_x(r_l) w_l^½. Sums of fixed blocks of pixels are added in order: the same on any number of threads.
fn gram(samples: &[&[[f32; 3]]], weight: &[f64], c: usize) -> DMatrix<f64> {
    let of_block = |block: &[&[[f32; 3]]]| {
        let scaled = DMatrix::from_fn(RADII, block.len(), |k, x| f64::from(block[x][k][c]) * weight[k].sqrt());
        &scaled * scaled.transpose()
    };
    let blocks: Vec<_> = samples.chunks(BLOCK).collect();
    let blocks: Vec<DMatrix<f64>> = parallel::map(blocks.len(), |k| of_block(blocks[k]));
    blocks.iter().fold(DMatrix::zeros(RADII, RADII), |sum, block| sum + block)
}
