//! The basis of a material, with the coefficients of every pixel.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::basis::BasisSize;

use super::numbers::BasisNumbers;
use crate::cpu::profile_sums;
use crate::rgb::Rgb;

/// Separable basis of a material, with the coefficients of every pixel; lengths are in pixels of the patch.
#[derive(Clone, Debug)]
pub struct ProjectedBasis {
    numbers: BasisNumbers,
    /// Coefficients c_l, shape `[l][height][width]`.
    coefficients: Vec<Vec<Rgb>>,
}

impl ProjectedBasis {
    /// Basis of a file, whose coefficients are computed of its planes: c_l(x) = Σ_h d_lh f_x(r_h). `None` where the file has
    /// no basis.
    #[must_use]
    pub fn of(material: &Bssrdf<'_>) -> Option<Self> {
        let numbers = BasisNumbers::of(material)?;
        Some(Self { coefficients: profile_sums(material, numbers.sums()), numbers })
    }

    /// Numbers of the basis, those of the file but for [`Self::homogeneous`] and [`Self::opaque`].
    #[must_use]
    pub fn numbers(&self) -> &BasisNumbers {
        &self.numbers
    }

    /// Basis of the mean profile, the same for all pixels: what a renderer draws that knows no heterogeneity. One term, as many
    /// Gaussians.
    #[must_use]
    pub fn homogeneous(&self) -> Self {
        let BasisSize { terms, gaussians } = self.numbers.size();
        let pixels = self.coefficients_of(0).len();
        let mut weights = vec![[0.0; 3]; gaussians];
        for (l, m) in (0..terms).flat_map(|l| (0..terms).map(move |m| (l, m))) {
            // The mean of f_x² has Σ_lm mean(c_l c_m) w_lma of Gaussian a.
            let mut mean = [0.0_f64; 3];
            for (a, b) in self.coefficients_of(l).iter().zip(self.coefficients_of(m)) {
                for c in 0..3 {
                    mean[c] += f64::from(a[c]) * f64::from(b[c]);
                }
            }
            #[allow(
                clippy::cast_precision_loss,
                clippy::cast_possible_truncation,
                reason = "a mean of numbers around 1"
            )]
            let mean = mean.map(|sum| (sum / pixels as f64) as f32);
            for (sum, weight) in weights.iter_mut().zip(self.numbers.weights_of(l, m)) {
                for c in 0..3 {
                    sum[c] += mean[c] * weight[c];
                }
            }
        }
        Self { numbers: self.numbers.with_weights(weights), coefficients: vec![vec![[1.0; 3]; pixels]] }
    }

    /// The same material with light that leaves where it enters: what a renderer draws that knows no scattering.
    #[must_use]
    pub fn opaque(&self) -> Self {
        Self { numbers: self.numbers.opaque(), coefficients: self.coefficients.clone() }
    }

    /// Coefficients c_l of all pixels for one l, linear Rec. 709; shape `[height][width]`.
    #[must_use]
    pub fn coefficients_of(&self, l: usize) -> &[Rgb] {
        &self.coefficients[l]
    }

    /// Exitance of the whole patch, row by row, for `irradiance` of the whole patch: what the passes `blur_patch_*.wgsl` draw.
    ///
    /// # Panics
    /// If `irradiance` is shorter than the patch.
    #[must_use]
    pub fn exitance(&self, irradiance: &[Rgb]) -> Vec<Rgb> {
        assert!(irradiance.len() >= self.coefficients_of(0).len(), "irradiance of every pixel");
        self.lit(|pixel| irradiance[pixel])
    }

    /// Exitance of the whole patch, row by row, for an irradiance of 1 everywhere.
    #[must_use]
    pub fn albedo(&self) -> Vec<Rgb> {
        self.lit(|_| [1.0; 3])
    }

    /// Exitance for an irradiance by the number of the pixel.
    fn lit(&self, irradiance: impl Fn(usize) -> Rgb) -> Vec<Rgb> {
        let header = self.numbers.header();
        let terms = self.numbers.size().terms;
        let pixels = self.coefficients_of(0).len();
        let mut exitance = vec![[0.0; 3]; pixels];
        let mut between = vec![0.0; pixels];
        let cascade = self.numbers.cascade();
        for c in 0..3 {
            // S_m = Σ_la w_lma G_a * c_l E.
            let mut sums = vec![vec![0.0_f32; pixels]; terms];
            for l in 0..terms {
                let weighted = self.coefficients_of(l).iter().enumerate();
                let mut map: Vec<f32> = weighted.map(|(pixel, rgb)| rgb[c] * irradiance(pixel)[c]).collect();
                for (a, stage) in cascade.stages().iter().enumerate() {
                    stage.blur(&mut map, &mut between, [header.width, header.height], header.addressing);
                    for (m, sum) in sums.iter_mut().enumerate() {
                        let weight = self.numbers.weights_of(l, m)[a][c];
                        sum.iter_mut().zip(&map).for_each(|(sum, blurred)| *sum += weight * blurred);
                    }
                }
            }
            for (m, sum) in sums.iter().enumerate() {
                for ((exitance, rgb), sum) in exitance.iter_mut().zip(self.coefficients_of(m)).zip(sum) {
                    exitance[c] += rgb[c] * sum;
                }
            }
        }
        exitance
    }
}
