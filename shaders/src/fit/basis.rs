//! The fit at a given size.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::BssrdfHeader;

use super::gaussians;
use super::radial::Radial;
use crate::separable::{BasisSize, MAX_GAUSSIANS, MAX_TERMS, SeparableBasis};

impl SeparableBasis {
    /// Basis of a material: takes a tenth of a second for one of 96 × 96 pixels.
    ///
    /// # Panics
    /// If `size` is out of range.
    #[must_use]
    pub fn of(material: &Bssrdf<'_>, size: BasisSize) -> Self {
        assert!((1..=MAX_TERMS).contains(&size.terms) && (1..=MAX_GAUSSIANS).contains(&size.gaussians), "{size:?}");
        Self::from_radial(*material.header(), Radial::of(material, size.terms), size)
    }

    pub(super) fn from_radial(header: BssrdfHeader, radial: Radial, size: BasisSize) -> Self {
        let (sigmas, weights) = gaussians::fit(&header, &radial, size);
        Self { header, size, coefficients: radial.coefficients, sigmas, weights }
    }

    /// Basis of the mean profile, the same for all pixels: what a renderer draws that knows no heterogeneity.
    ///
    /// # Panics
    /// If `gaussians` is out of range.
    #[must_use]
    pub fn homogeneous(material: &Bssrdf<'_>, gaussians: usize) -> Self {
        let size = BasisSize { terms: 1, gaussians };
        assert!((1..=MAX_GAUSSIANS).contains(&gaussians), "{gaussians}");
        Self::from_radial(*material.header(), Radial::mean_of(material), size)
    }
}
