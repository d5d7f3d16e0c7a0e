//! A material as a few weighted irradiance maps and shared Gaussians: heterogeneous scattering at the cost of separable
//! blurs.
//!
//! Rd(i, j) = f_i(r) f_j(r) with f_x(r) = exp(½ P̂_x(r)) (Yatagawa et al. 2020, eq. 2). With f_x(r) ≈ Σ_l c_l(x) g_l(r) and
//! every product g_l g_m as a sum of the same A Gaussians,
//!
//! M(x_o) = Σ_m c_m(x_o) Σ_l Σ_a w_lma (G_a * c_l E)(x_o),
//!
//! which takes L maps and A separable blurs of each, whatever the material.

mod cascade;
mod choose;
mod gaussians;
mod homogeneous;
mod radial;

pub use cascade::Stage;
pub use homogeneous::{mean_kernel, softened};
pub use radial::mean_profile;

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::BssrdfHeader;

use crate::cpu::Rgb;

/// Most radial functions: their maps and the sums of them fit the four targets that every device draws to at once.
pub const MAX_TERMS: usize = 2;
/// Most Gaussians.
pub const MAX_GAUSSIANS: usize = 8;

/// How finely a material is factorised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Detail {
    /// L, the radial functions: 1 or 2.
    pub terms: usize,
    /// A, the Gaussians, 1 to [`MAX_GAUSSIANS`].
    pub gaussians: usize,
}

impl Default for Detail {
    fn default() -> Self {
        Self { terms: 2, gaussians: 4 }
    }
}

/// A factorised material; lengths are in pixels.
#[derive(Clone, Debug)]
pub struct Factors {
    /// Size, pitch, window and addressing.
    pub header: BssrdfHeader,
    /// L and A.
    pub detail: Detail,
    /// c_l of every pixel; shape `[L][height][width]`, mm⁻¹.
    pub coefficients: Vec<Rgb>,
    /// Standard deviations σ_a by rising width.
    pub sigmas: Vec<f32>,
    /// w_lma, symmetric in l and m; shape `[L][L][A]`. G_a sums to 1.
    pub weights: Vec<Rgb>,
}

impl Factors {
    /// Factorises a material: a tenth of a second for one of 96 × 96 pixels.
    ///
    /// # Panics
    /// If `detail` is out of range.
    #[must_use]
    pub fn of(material: &Bssrdf<'_>, detail: Detail) -> Self {
        assert!(
            (1..=MAX_TERMS).contains(&detail.terms) && (1..=MAX_GAUSSIANS).contains(&detail.gaussians),
            "{detail:?}"
        );
        Self::from_radial(*material.header(), radial::Radial::of(material, detail.terms), detail)
    }

    fn from_radial(header: BssrdfHeader, radial: radial::Radial, detail: Detail) -> Self {
        let (sigmas, weights) = gaussians::fit(&header, &radial, detail);
        Self { header, detail, coefficients: radial.coefficients, sigmas, weights }
    }

    /// One profile for all pixels, the mean: what a renderer draws that knows no heterogeneity.
    ///
    /// # Panics
    /// If `gaussians` is out of range.
    #[must_use]
    pub fn homogeneous(material: &Bssrdf<'_>, gaussians: usize) -> Self {
        let detail = Detail { terms: 1, gaussians };
        assert!((1..=MAX_GAUSSIANS).contains(&gaussians), "{gaussians}");
        Self::from_radial(*material.header(), radial::Radial::mean_of(material), detail)
    }

    /// Whether there are as many numbers as L, A and the size of the patch say, and not too many.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        let Detail { terms, gaussians } = self.detail;
        let pixels = self.header.width as usize * self.header.height as usize;
        (1..=MAX_TERMS).contains(&terms)
            && (1..=MAX_GAUSSIANS).contains(&gaussians)
            && self.sigmas.len() == gaussians
            && self.weights.len() == terms * terms * gaussians
            && self.coefficients.len() == terms * pixels
    }

    /// w_lma of all Gaussians.
    #[must_use]
    pub fn weights_of(&self, l: usize, m: usize) -> &[Rgb] {
        let count = self.detail.gaussians;
        &self.weights[(l * self.detail.terms + m) * count..][..count]
    }

    /// c_l of all pixels.
    #[must_use]
    pub fn coefficients_of(&self, l: usize) -> &[Rgb] {
        let pixels = self.coefficients.len() / self.detail.terms;
        &self.coefficients[l * pixels..][..pixels]
    }
}
