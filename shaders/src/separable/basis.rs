//! The basis of a material: coefficients, widths and weights.

use subsurf_decoder::bssrdf::BssrdfHeader;

use crate::rgb::Rgb;

/// Largest L: two maps and the two sums of them fit the four targets that every device draws to at once.
pub const MAX_TERMS: usize = 2;
/// Largest A.
pub const MAX_GAUSSIANS: usize = 8;

/// Number of terms of a separable basis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BasisSize {
    /// L, the number of radial functions, 1 to [`MAX_TERMS`].
    pub terms: usize,
    /// A, the number of Gaussians, 1 to [`MAX_GAUSSIANS`].
    pub gaussians: usize,
}

impl Default for BasisSize {
    fn default() -> Self {
        Self { terms: 2, gaussians: 4 }
    }
}

/// Separable basis of a material; lengths are in pixels of the patch.
#[derive(Clone, Debug)]
pub struct SeparableBasis {
    /// Size, pitch, window and addressing of the material.
    pub header: BssrdfHeader,
    /// L and A.
    pub size: BasisSize,
    /// Coefficients c_l of every pixel; shape `[L][height][width]`, linear Rec. 709, mm⁻¹.
    pub coefficients: Vec<Rgb>,
    /// Standard deviations σ_a in pixels, by rising width; shape `[A]`.
    pub sigmas: Vec<f32>,
    /// Weights w_lma, symmetric in l and m; shape `[L][L][A]`. G_a sums to 1.
    pub weights: Vec<Rgb>,
}

impl SeparableBasis {
    /// Whether there are as many numbers as L, A and the size of the patch say, and L and A are in range.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        let BasisSize { terms, gaussians } = self.size;
        let pixels = self.header.width as usize * self.header.height as usize;
        (1..=MAX_TERMS).contains(&terms)
            && (1..=MAX_GAUSSIANS).contains(&gaussians)
            && self.sigmas.len() == gaussians
            && self.weights.len() == terms * terms * gaussians
            && self.coefficients.len() == terms * pixels
    }

    /// Weights w_lma of all Gaussians for one l and m; shape `[A]`.
    #[must_use]
    pub fn weights_of(&self, l: usize, m: usize) -> &[Rgb] {
        let count = self.size.gaussians;
        &self.weights[(l * self.size.terms + m) * count..][..count]
    }

    /// Coefficients c_l of all pixels for one l; shape `[height][width]`.
    #[must_use]
    pub fn coefficients_of(&self, l: usize) -> &[Rgb] {
        let pixels = self.coefficients.len() / self.size.terms;
        &self.coefficients[l * pixels..][..pixels]
    }
}
