//! f_x(r) ≈ Σ_l c_l(x) g_l(r): the radial functions that all pixels share, by a weighted singular value decomposition.

#![allow(clippy::cast_possible_truncation, reason = "results in double precision are kept in single; counts are small")]

use nalgebra::{DMatrix, SymmetricEigen};
use rayon::prelude::*;
use subsurf_decoder::Bssrdf;

use crate::rgb::Rgb;

/// Number of radii at which functions are sampled, 0 to r_max.
const RADII: usize = 64;
/// Least weight of a radius in pixels: weights are shares of the area, max(r, this), so that light near the beam counts.
const LEAST_RADIUS: f64 = 0.3;

/// Radial functions of a material, and their coefficients.
#[derive(Clone)]
pub(super) struct Radial {
    /// Coefficients c_l, shape `[L][pixel]`, mm⁻¹.
    pub(super) coefficients: Vec<Rgb>,
    /// Functions g_l at the radii, shape `[L][radius]`.
    functions: Vec<Rgb>,
    /// Pixels from one radius to the next.
    step: f64,
}

impl Radial {
    /// Decomposition of a material into `terms` radial functions.
    pub(super) fn of(material: &Bssrdf<'_>, terms: usize) -> Self {
        let header = material.header();
        let step = f64::from(header.r_max_mm / header.pitch_mm) / (RADII - 1) as f64;
        let samples = samples(material);
        let pixels = samples.len();
        let mut coefficients = vec![[0.0; 3]; terms * pixels];
        let mut functions = vec![[0.0; 3]; terms * RADII];
        let weight: Vec<f64> = (0..RADII).map(|k| (k as f64 * step).max(LEAST_RADIUS)).collect();
        for c in 0..3 {
            // Eigenvectors of Σ_x (√w f_x)(√w f_x)ᵀ, largest eigenvalues first.
            let gram = gram(&samples, &weight, c);
            let eigen = SymmetricEigen::new(gram);
            let mut order: Vec<usize> = (0..RADII).collect();
            order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
            for (l, &column) in order.iter().take(terms).enumerate() {
                let vector = eigen.eigenvectors.column(column);
                // The sign is arbitrary; with this one the first function is a mean profile.
                let sign = vector.sum().signum();
                let g: Vec<f64> = (0..RADII).map(|k| sign * vector[k] / weight[k].sqrt()).collect();
                let of_pixels: Vec<f64> = samples
                    .par_iter()
                    .map(|f| (0..RADII).map(|k| weight[k] * f64::from(f[k][c]) * g[k]).sum())
                    .collect();
                // Coefficients of about 1: half floats hold them, whatever the material.
                let scale = of_pixels.iter().fold(0.0_f64, |most, value| most.max(value.abs())).max(1e-30);
                for (k, g) in g.iter().enumerate() {
                    functions[l * RADII + k][c] = (g * scale) as f32;
                }
                for (pixel, value) in of_pixels.iter().enumerate() {
                    coefficients[l * pixels + pixel][c] = (value / scale) as f32;
                }
            }
        }
        Self { coefficients, functions, step }
    }

    /// One function for all pixels: the root of the mean reflectance.
    pub(super) fn mean_of(material: &Bssrdf<'_>) -> Self {
        let header = material.header();
        let mean = mean_profile(material);
        let radius = |k: usize| header.r_max_mm * k as f32 / (RADII - 1) as f32;
        Self {
            coefficients: vec![[1.0; 3]; header.width as usize * header.height as usize],
            functions: (0..RADII).map(|k| mean(radius(k)).map(f32::sqrt)).collect(),
            step: f64::from(header.r_max_mm / header.pitch_mm) / (RADII - 1) as f64,
        }
    }

    /// The first `terms` functions alone.
    pub(super) fn truncated(mut self, terms: usize) -> Self {
        let pixels = self.coefficients.len() * RADII / self.functions.len();
        self.coefficients.truncate(terms * pixels);
        self.functions.truncate(terms * RADII);
        self
    }

    /// Value g_l(r) of a channel, r in pixels, at most r_max.
    pub(super) fn at(&self, l: usize, r: f64, c: usize) -> f64 {
        let position = (r / self.step).min((RADII - 1) as f64);
        let k = (position as usize).min(RADII - 2);
        let w = position - k as f64;
        let value = |k: usize| f64::from(self.functions[l * RADII + k][c]);
        (1.0 - w) * value(k) + w * value(k + 1)
    }
}

/// Mean profile of a material: Rd in mm⁻² between two pixels alike, the mean over all pixels, as a function of their distance in
/// mm; 0 beyond r_max.
pub fn mean_profile(material: &Bssrdf<'_>) -> impl Fn(f32) -> Rgb + Sync + use<> {
    let r_max_mm = material.header().r_max_mm;
    let samples = samples(material);
    let mean = |k: usize| {
        let sum = samples.iter().fold([0.0; 3], |sum: Rgb, f| [0, 1, 2].map(|c| sum[c] + f[k][c] * f[k][c]));
        sum.map(|sum| sum / samples.len() as f32)
    };
    let means: Vec<Rgb> = (0..RADII).map(mean).collect();
    move |r_mm| {
        if r_mm > r_max_mm {
            return [0.0; 3];
        }
        let position = r_mm / r_max_mm * (RADII - 1) as f32;
        let k = (position as usize).min(RADII - 2);
        let w = position - k as f32;
        [0, 1, 2].map(|c| (1.0 - w) * means[k][c] + w * means[k + 1][c])
    }
}

/// Profiles f_x at all radii, shape `[pixel][radius]`, mm⁻¹.
fn samples(material: &Bssrdf<'_>) -> Vec<Vec<Rgb>> {
    let header = material.header();
    let positions = (0..header.height).flat_map(|y| (0..header.width).map(move |x| [x, y].map(u32::cast_signed)));
    let positions: Vec<[i32; 2]> = positions.collect();
    let radius = |k: usize| header.r_max_mm * k as f32 / (RADII - 1) as f32;
    let knots: Vec<_> = (0..RADII).map(|k| material.knot(radius(k).min(header.r_max_mm))).collect();
    let profile = |&position: &[i32; 2]| {
        let profile = material.profile(position);
        let f = |knot: &Option<_>| knot.map_or([0.0; 3], |knot| profile.at(knot).map(|p: f32| (0.5 * p).exp()));
        knots.iter().map(f).collect()
    };
    positions.par_iter().map(profile).collect()
}

/// Gram matrix Σ_x w_k^½ f_x(r_k) f_x(r_l) w_l^½. Sums of fixed blocks of pixels are added in order: the same on any number of threads.
fn gram(samples: &[Vec<Rgb>], weight: &[f64], c: usize) -> DMatrix<f64> {
    const BLOCK: usize = 1024;
    let blocks: Vec<DMatrix<f64>> = samples
        .par_chunks(BLOCK)
        .map(|block| {
            let mut sum = DMatrix::zeros(RADII, RADII);
            for f in block {
                let scaled: Vec<f64> = f.iter().zip(weight).map(|(f, w)| f64::from(f[c]) * w.sqrt()).collect();
                for k in 0..RADII {
                    for l in 0..RADII {
                        sum[(k, l)] += scaled[k] * scaled[l];
                    }
                }
            }
            sum
        })
        .collect();
    blocks.iter().fold(DMatrix::zeros(RADII, RADII), |sum, block| sum + block)
}
