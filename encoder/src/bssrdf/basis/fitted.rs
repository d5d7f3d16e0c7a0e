//! A fitted basis, and its section of a file.

use subsurf_decoder::bssrdf::basis::{BasisSize, MAX_PROJECTION, MAX_WEIGHT};

use super::nodes::Nodes;
use super::params::Params;
use crate::error::{Error, Result};

/// Separable basis of a material, as it stands in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedBasis {
    /// L and A.
    pub size: BasisSize,
    /// Nodes of a profile, S.
    pub samples: u16,
    /// Standard deviations σ_a in pixels, by rising width; shape `[A]`.
    pub sigmas: Vec<f32>,
    /// Weights w_lma, dimensionless; shape `[pair l ≤ m][A]`, linear Rec. 709.
    pub weights: Vec<[f32; 3]>,
    /// Factors d_lh in mm; shape `[L][S]`, linear Rec. 709.
    pub projection: Vec<[f32; 3]>,
    /// PSNR in dB against the gather, the least of uniform, disc and line light, where the fit looked.
    pub psnr_db: f64,
}

impl FittedBasis {
    /// Numbers of a fit, with coefficients of at most 1: half floats hold them, whatever the material.
    ///
    /// `largest` are those of |c_l| over the patch, shape `[l][c]`.
    pub(super) fn new(params: &Params, nodes: &Nodes, largest: &[[f64; 3]], psnr_db: f64) -> Result<Self> {
        let size = params.size;
        let mut projection = vec![[0.0_f32; 3]; size.terms * usize::from(nodes.samples)];
        let mut weights = vec![[0.0_f32; 3]; size.pairs() * size.gaussians];
        for c in 0..3 {
            let channel = &params.channels[c];
            let factor = |l: usize, k: usize| channel.d[l * nodes.count() + k] * nodes.inverse_scale(k, c);
            let scales: Vec<f64> = (0..size.terms)
                .map(|l| {
                    let most = (0..nodes.count()).map(|k| factor(l, k).abs()).fold(0.0, f64::max);
                    // Of materials that are nearly black, coefficients are smaller than factors may be large.
                    largest[l][c].max(most / (0.5 * f64::from(MAX_PROJECTION))).max(f64::MIN_POSITIVE)
                })
                .collect();
            for l in 0..size.terms {
                for (k, h) in nodes.at.iter().enumerate() {
                    projection[l * usize::from(nodes.samples) + h][c] = single(factor(l, k) / scales[l]);
                }
                for m in l..size.terms {
                    let pair = size.pair(l, m) * size.gaussians;
                    for a in 0..size.gaussians {
                        weights[pair + a][c] = single(channel.w[pair + a] * scales[l] * scales[m]);
                    }
                }
            }
        }
        let sigmas = params.sigmas().map(single).collect();
        if let Some(weight) = weights.iter().flatten().find(|weight| !(-MAX_WEIGHT..=MAX_WEIGHT).contains(*weight)) {
            return Err(Error::Request(format!(
                "a separable basis would need a weight of {weight:e}, and a file holds up to {MAX_WEIGHT:e}: the material \
                 gives back far more light than it takes"
            )));
        }
        Ok(Self { size, samples: nodes.samples, sigmas, weights, projection, psnr_db })
    }

    /// The `sepb` section.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let numbers = self.sigmas.iter().chain(self.weights.as_flattened()).chain(self.projection.as_flattened());
        let mut bytes = self.size.to_bytes().to_vec();
        bytes.extend(numbers.flat_map(|number| number.to_le_bytes()));
        bytes
    }
}

#[allow(clippy::cast_possible_truncation, reason = "fitted in double precision, stored in single")]
fn single(value: f64) -> f32 {
    value as f32
}
