//! The cascade of Gaussians: each stage blurs what the one before left, with taps further and further apart.

/// Stage of the cascade along one axis: taps at k · stride pixels, |k| ≤ taps, weighted by exp(−½ (k · stride / σ)²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CascadeStage {
    /// Standard deviation σ in pixels.
    pub sigma: f32,
    /// Distance of neighbouring taps in pixels.
    pub stride: i32,
    /// Number of taps to each side.
    pub taps: i32,
    /// Standard deviation that the stage adds, in pixels: σ where taps are close.
    pub step: f32,
    /// Distance of taps in pixels that the blur so far allows; 0 for the first stage.
    pub sparse: f32,
}

/// Distance of taps, in standard deviations of the blur so far: frequencies that such taps mistake for others
/// are down to exp(−2π² / SPARSE²) = 0.2 %.
const SPARSE: f64 = 1.8;
/// Cut of a Gaussian, in standard deviations.
const CUT: f64 = 3.2;

impl CascadeStage {
    /// CascadeStages whose first a have the variance of a Gaussian of σ_a pixels that is sampled at whole pixels.
    #[must_use]
    pub fn cascade(sigmas: &[f32]) -> Vec<Self> {
        let mut reached = 0.0_f64;
        let stage = |&sigma: &f32| {
            let wanted = (sampled_variance(f64::from(sigma)) - reached).max(1e-6);
            let sparse = SPARSE * reached.sqrt();
            let stride = sparse.floor().max(1.0);
            let taps = (CUT * wanted.sqrt() / stride).ceil().max(1.0);
            // The σ with which few taps have the variance that is wanted: it grows with σ.
            let (mut low, mut high) = (0.05 * stride, 4.0 * (wanted.sqrt() + stride));
            for _ in 0..48 {
                let middle = 0.5 * (low + high);
                if variance(middle, stride, taps) < wanted { low = middle } else { high = middle }
            }
            reached += variance(low, stride, taps);
            #[allow(clippy::cast_possible_truncation, reason = "pixels, within a window")]
            let stage = Self {
                sigma: low as f32,
                stride: stride as i32,
                taps: taps as i32,
                step: wanted.sqrt() as f32,
                sparse: sparse as f32,
            };
            stage
        };
        sigmas.iter().map(stage).collect()
    }

    /// Offsets in pixels and weights of all taps, of sum 1.
    #[must_use]
    pub fn weights(&self) -> Vec<(i32, f32)> {
        #[allow(clippy::cast_precision_loss, reason = "pixels, within a window")]
        let weight = |offset: i32| (-0.5 * (offset as f32 / self.sigma).powi(2)).exp();
        let offsets = (-self.taps..=self.taps).map(|k| k * self.stride);
        let sum: f32 = offsets.clone().map(weight).sum();
        offsets.map(|offset| (offset, weight(offset) / sum)).collect()
    }
}

/// Variance of a Gaussian at taps that are `stride` apart.
fn variance(sigma: f64, stride: f64, taps: f64) -> f64 {
    let (mut sum, mut moment) = (0.0, 0.0);
    let mut k = -taps;
    while k <= taps {
        let weight = (-0.5 * (k * stride / sigma).powi(2)).exp();
        sum += weight;
        moment += weight * (k * stride).powi(2);
        k += 1.0;
    }
    moment / sum
}

/// Variance of a Gaussian at whole pixels.
fn sampled_variance(sigma: f64) -> f64 {
    variance(sigma, 1.0, (8.0 * sigma).ceil() + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_add_up_to_the_gaussians() {
        let sigmas = [0.45, 1.1, 2.4, 5.6];
        // What a point becomes, step by step.
        let mut line = vec![0.0_f64; 129];
        line[64] = 1.0;
        for (stage, sigma) in CascadeStage::cascade(&sigmas).iter().zip(sigmas) {
            let weights = stage.weights();
            let at = |line: &[f64], x: i32| usize::try_from(x).ok().and_then(|x| line.get(x)).copied().unwrap_or(0.0);
            let blur = |x: i32| weights.iter().map(|(offset, w)| f64::from(*w) * at(&line, x + offset)).sum();
            line = (0..129).map(blur).collect();
            let sum: f64 = (0..129).map(|x| (-0.5 * (f64::from(x - 64) / f64::from(sigma)).powi(2)).exp()).sum();
            for x in 0..129 {
                let expected = (-0.5 * (f64::from(x - 64) / f64::from(sigma)).powi(2)).exp() / sum;
                let error = (line[x as usize] - expected).abs() * sum;
                assert!(error < 0.025, "σ = {sigma}: {error} of the peak at {x}");
            }
        }
        let taps: Vec<i32> = CascadeStage::cascade(&sigmas).iter().map(|stage| stage.taps).collect();
        assert!(taps.iter().all(|taps| *taps <= 7), "{taps:?}");
    }
}
