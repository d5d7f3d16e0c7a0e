//! What a basis makes of the lights, by the blurs of the renderer.

use super::params::Params;
use super::patch::{Lit, Patch};
use crate::math::parallel;

/// Σ (M − target)² / peak² over all lights of the fit, samples and channels.
pub(super) fn loss(params: &Params, patches: &[Patch]) -> f64 {
    let tasks: Vec<(&Patch, &Lit)> =
        patches.iter().flat_map(|patch| patch.lit.iter().map(move |lit| (patch, lit))).collect();
    errors(params, &tasks).iter().sum()
}

/// Least PSNR in dB over the lights by which the error is judged, peak the largest exitance of the gather.
pub(super) fn psnr_db(params: &Params, patches: &[Patch]) -> f64 {
    let lights = patches[0].judged.len();
    let of_light = |light: usize| {
        let tasks: Vec<(&Patch, &Lit)> = patches.iter().map(|patch| (patch, &patch.judged[light])).collect();
        let samples: usize = patches.iter().map(|patch| patch.samples.len()).sum();
        #[allow(clippy::cast_precision_loss, reason = "a few thousand")]
        let mean = errors(params, &tasks).iter().sum::<f64>() / (3 * samples) as f64;
        // Nothing is closer than single precision.
        -10.0 * mean.max(1e-14).log10()
    };
    (0..lights).map(of_light).fold(f64::INFINITY, f64::min)
}

/// Squared errors of every task, summed over its samples and channels.
fn errors(params: &Params, tasks: &[(&Patch, &Lit)]) -> Vec<f64> {
    let all: Vec<(&Patch, &Lit, usize)> = tasks.iter().flat_map(|(p, lit)| [0, 1, 2].map(|c| (*p, *lit, c))).collect();
    let errors = parallel::map(all.len(), |k| {
        let (patch, lit, c) = all[k];
        error(params, patch, lit, c)
    });
    errors.chunks(3).map(|of_channels| of_channels.iter().sum()).collect()
}

fn error(params: &Params, patch: &Patch, lit: &Lit, c: usize) -> f64 {
    let terms = params.size.terms;
    let coefficients: Vec<Vec<f32>> = (0..terms).map(|l| patch.coefficients(params, l, c)).collect();
    let cascade = params.cascade();
    let mut between = vec![0.0; patch.pixels()];
    // S_m at the samples.
    let mut sums = vec![vec![0.0_f64; patch.samples.len()]; terms];
    for (l, of_term) in coefficients.iter().enumerate() {
        let mut map: Vec<f32> = of_term.iter().zip(&lit.irradiance).map(|(c, e)| c * e).collect();
        for (a, stage) in cascade.stages().iter().enumerate() {
            stage.blur(&mut map, &mut between, patch.size, patch.addressing);
            for (m, sums) in sums.iter_mut().enumerate() {
                let weight = params.weight(l, m, a, c);
                let samples = patch.samples.iter().map(|sample| f64::from(map[*sample]));
                sums.iter_mut().zip(samples).for_each(|(sum, blurred)| *sum += weight * blurred);
            }
        }
    }
    let of_sample = |(k, target): (usize, &f32)| {
        let sample = patch.samples[k];
        let found: f64 = (0..terms).map(|m| f64::from(coefficients[m][sample]) * sums[m][k]).sum();
        ((found - f64::from(*target)) * lit.inverse_peak).powi(2)
    };
    lit.target[c].iter().enumerate().map(of_sample).sum()
}
