//! The cascade of Gaussians: each stage blurs what the one before left, with taps further and further apart.

use super::layout::MAX_GAUSSIANS;

/// Largest number of taps to each side: what the ranges of widths allow.
pub(super) const MAX_TAPS: usize = 63;
/// Distance of taps, in standard deviations of the blur so far: frequencies that such taps mistake for others
/// are down to exp(−2π² / SPARSE²) = 0.2 %.
const SPARSE: f64 = 1.8;
/// Cut of a Gaussian, in standard deviations.
const CUT: f64 = 3.2;

/// Stage of the cascade along one axis: taps at k · stride pixels, |k| ≤ taps, weighted by exp(−½ (k · stride / σ)²).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CascadeStage {
    /// Standard deviation σ in pixels.
    pub sigma: f32,
    /// Distance of neighbouring taps in pixels, at least 1.
    pub stride: i32,
    /// Number of taps to each side, 1 to 63.
    pub taps: i32,
    /// Standard deviation that the stage adds, in pixels: σ where taps are close.
    pub step: f32,
    /// Distance of taps in pixels that the blur so far allows; 0 for the first stage.
    pub sparse: f32,
}

/// Stages of blurs, one for each Gaussian of a basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cascade {
    stages: [CascadeStage; MAX_GAUSSIANS],
    count: usize,
}

impl Cascade {
    /// Stages whose first a have the variance of a Gaussian of σ_a pixels that is sampled at whole pixels; of at most
    /// [`MAX_GAUSSIANS`] widths, which rise.
    #[must_use]
    pub fn new(sigmas: impl IntoIterator<Item = f32>) -> Self {
        let mut cascade = Self { stages: [CascadeStage::default(); MAX_GAUSSIANS], count: 0 };
        let mut reached = 0.0_f64;
        for (stage, sigma) in cascade.stages.iter_mut().zip(sigmas) {
            let wanted = (sampled_variance(f64::from(sigma)) - reached).max(1e-6);
            let sparse = SPARSE * libm::sqrt(reached);
            let stride = libm::floor(sparse).max(1.0);
            #[allow(clippy::cast_precision_loss, reason = "a small constant")]
            let taps = libm::ceil(CUT * libm::sqrt(wanted) / stride).clamp(1.0, MAX_TAPS as f64);
            // The σ with which few taps have the variance that is wanted: it grows with σ.
            let (mut low, mut high) = (0.05 * stride, 4.0 * (libm::sqrt(wanted) + stride));
            for _ in 0..48 {
                let middle = 0.5 * (low + high);
                if variance(middle, stride, taps) < wanted { low = middle } else { high = middle }
            }
            reached += variance(low, stride, taps);
            #[allow(clippy::cast_possible_truncation, reason = "pixels, within a window")]
            let numbers = (low as f32, stride as i32, taps as i32, libm::sqrt(wanted) as f32, sparse as f32);
            let (sigma, stride, taps, step, sparse) = numbers;
            *stage = CascadeStage { sigma, stride, taps, step, sparse };
            cascade.count = cascade.count.saturating_add(1);
        }
        cascade
    }

    /// Stages in their order, at most [`MAX_GAUSSIANS`].
    #[must_use]
    pub fn stages(&self) -> &[CascadeStage] {
        self.stages.get(..self.count).unwrap_or(&self.stages)
    }
}

impl CascadeStage {
    /// Weights of the taps at 0, 1, 2 ... strides to either side; with both sides their sum is 1.
    pub(super) fn weights(&self) -> [f32; MAX_TAPS + 1] {
        let mut weights = [0.0_f32; MAX_TAPS + 1];
        let mut sum = 0.0_f32;
        for (weight, k) in weights.iter_mut().zip(0_i32..=self.taps) {
            #[allow(clippy::cast_precision_loss, reason = "pixels, within a window")]
            let distance = k.saturating_mul(self.stride) as f32 / self.sigma;
            *weight = libm::expf(-0.5 * distance * distance);
            sum += if k == 0 { *weight } else { 2.0 * *weight };
        }
        weights.map(|weight| weight / sum)
    }
}

/// Variance of a Gaussian at taps that are `stride` apart.
fn variance(sigma: f64, stride: f64, taps: f64) -> f64 {
    let (mut sum, mut moment) = (0.0, 0.0);
    let mut k = -taps;
    while k <= taps {
        let distance = k * stride / sigma;
        let weight = libm::exp(-0.5 * distance * distance);
        sum += weight;
        moment += weight * (k * stride) * (k * stride);
        k += 1.0;
    }
    moment / sum
}

/// Variance of a Gaussian at whole pixels.
fn sampled_variance(sigma: f64) -> f64 {
    // Sampled this finely, a Gaussian has the variance of the continuous one to the last digit.
    if sigma > 4.0 { sigma * sigma } else { variance(sigma, 1.0, libm::ceil(8.0 * sigma) + 1.0) }
}
