//! Numbers of a separable basis, without any pixel: all that a device needs beside the planes of the file.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_decoder::bssrdf::basis::{BasisSize, Cascade};

use super::sums::ProfileSums;
use crate::rgb::Rgb;

/// Standard deviation in pixels of a Gaussian that spreads nothing to the next pixel.
const POINT: f32 = 0.05;

/// Numbers of a separable basis: what projects the profiles of pixels, Gaussians and their weights; lengths are in pixels of the
/// patch.
#[derive(Clone, Debug)]
pub struct BasisNumbers {
    header: BssrdfHeader,
    size: BasisSize,
    sums: ProfileSums,
    sigmas: Vec<f32>,
    /// Weights w_lma, shape `[L][L][A]`.
    weights: Vec<Rgb>,
}

impl BasisNumbers {
    /// Numbers of a file. `None` where it has no basis.
    #[must_use]
    pub fn of(material: &Bssrdf<'_>) -> Option<Self> {
        let basis = material.basis()?;
        let size = basis.size();
        let pairs = (0..size.terms).flat_map(|l| (0..size.terms).map(move |m| (l, m)));
        let weights = pairs.flat_map(|(l, m)| (0..size.gaussians).map(move |a| basis.weight(l, m, a)));
        Some(Self {
            header: *material.header(),
            size,
            sums: ProfileSums::coefficients(material.header(), basis),
            sigmas: basis.sigmas().collect(),
            weights: weights.collect(),
        })
    }

    /// One term of the same Gaussians with other weights, whose coefficients are 1 for all pixels.
    pub(super) fn with_weights(&self, weights: Vec<Rgb>) -> Self {
        Self {
            header: self.header,
            size: BasisSize { terms: 1, ..self.size },
            sums: ProfileSums::one(),
            sigmas: self.sigmas.clone(),
            weights,
        }
    }

    /// Numbers of a material like this one from which light leaves where it enters: one Gaussian so narrow that it spreads nothing,
    /// with the weights of all.
    #[must_use]
    pub fn opaque(&self) -> Self {
        let terms = self.size.terms;
        let pairs = (0..terms).flat_map(|l| (0..terms).map(move |m| (l, m)));
        let sum = |(l, m)| self.weights_of(l, m).iter().fold([0.0; 3], |sum, w| [0, 1, 2].map(|c| sum[c] + w[c]));
        Self {
            size: BasisSize { gaussians: 1, ..self.size },
            sigmas: vec![POINT],
            weights: pairs.map(sum).collect(),
            ..self.clone()
        }
    }

    /// Size, pitch, window and addressing of the material.
    #[must_use]
    pub fn header(&self) -> &BssrdfHeader {
        &self.header
    }

    /// L and A.
    #[must_use]
    pub fn size(&self) -> BasisSize {
        self.size
    }

    /// Coefficients c_l as sums over the profile of a pixel.
    #[must_use]
    pub fn sums(&self) -> &ProfileSums {
        &self.sums
    }

    /// Standard deviations σ_a in pixels, by rising width; shape `[A]`.
    #[must_use]
    pub fn sigmas(&self) -> &[f32] {
        &self.sigmas
    }

    /// Stages of the blurs.
    #[must_use]
    pub fn cascade(&self) -> Cascade {
        Cascade::new(self.sigmas.iter().copied())
    }

    /// Weights w_lma of all Gaussians for one l and m, symmetric in them, linear Rec. 709; shape `[A]`. G_a sums to 1.
    #[must_use]
    pub fn weights_of(&self, l: usize, m: usize) -> &[Rgb] {
        let count = self.size.gaussians;
        &self.weights[(l * self.size.terms + m) * count..][..count]
    }
}
