//! Homogeneous media, measured and inverted.

use crate::simulate::fresnel::boundary_a;

/// Scattering and absorption of a medium, linear Rec. 709 channels, in mm⁻¹.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Reduced scattering coefficient σ_s'.
    pub sigma_s: [f64; 3],
    /// Absorption coefficient σ_a.
    pub sigma_a: [f64; 3],
}

/// The twelve materials of Jensen, Marschner, Levoy and Hanrahan, *A practical model for subsurface light transport*
/// (SIGGRAPH 2001), fig. 5: name, σ_s' and σ_a in mm⁻¹.
pub const MEASURED: [(&str, Medium); 12] = [
    ("apple", medium([2.29, 2.39, 1.97], [0.0030, 0.0034, 0.046])),
    ("chicken1", medium([0.15, 0.21, 0.38], [0.015, 0.077, 0.19])),
    ("chicken2", medium([0.19, 0.25, 0.32], [0.018, 0.088, 0.20])),
    ("cream", medium([7.38, 5.47, 3.15], [0.0002, 0.0028, 0.0163])),
    ("ketchup", medium([0.18, 0.07, 0.03], [0.061, 0.97, 1.45])),
    ("marble", medium([2.19, 2.62, 3.00], [0.0021, 0.0041, 0.0071])),
    ("potato", medium([0.68, 0.70, 0.55], [0.0024, 0.0090, 0.12])),
    ("skimmilk", medium([0.70, 1.22, 1.90], [0.0014, 0.0025, 0.0142])),
    ("skin1", medium([0.74, 0.88, 1.01], [0.032, 0.17, 0.48])),
    ("skin2", medium([1.09, 1.59, 1.79], [0.013, 0.070, 0.145])),
    ("spectralon", medium([11.6, 20.4, 14.9], [0.0, 0.0, 0.0])),
    ("wholemilk", medium([2.55, 3.21, 3.77], [0.0011, 0.0024, 0.014])),
];

const fn medium(sigma_s: [f64; 3], sigma_a: [f64; 3]) -> Medium {
    Medium { sigma_s, sigma_a }
}

impl Medium {
    /// The measured material of that name, upper or lower case.
    #[must_use]
    pub fn measured(name: &str) -> Option<Self> {
        let known = MEASURED.iter().find(|(known, _)| known.eq_ignore_ascii_case(name));
        known.map(|(_, medium)| *medium)
    }

    /// Refractive index η of the measured material of that name: 1.5 of marble, 1.3 of all others (Jensen et al. 2001, fig. 5).
    #[must_use]
    pub fn measured_eta(name: &str) -> f64 {
        if name.eq_ignore_ascii_case("marble") { 1.5 } else { 1.3 }
    }

    /// Σ w_k medium_k: coefficients of a mixture are linear in its parts.
    #[must_use]
    pub fn mix(parts: impl IntoIterator<Item = (f64, Self)>) -> Self {
        let mut sum = medium([0.0; 3], [0.0; 3]);
        for (weight, part) in parts {
            for c in 0..3 {
                sum.sigma_s[c] += weight * part.sigma_s[c];
                sum.sigma_a[c] += weight * part.sigma_a[c];
            }
        }
        sum
    }

    /// The medium with a given diffuse albedo and diffuse mean free path 1/σ_tr in mm, per channel.
    ///
    /// The inversion of Jensen and Buhler 2002 (*A rapid hierarchical rendering technique for translucent materials*,
    /// section 2.3), with [`reduced_albedo_to_diffuse`] in place of the dipole's albedo, so that simulating the
    /// medium gives back the albedo that was asked for. Albedos are clamped to 0.001 .. 0.99: beyond that, σ_t' runs
    /// away and no grid resolves it.
    #[must_use]
    pub fn from_albedo(albedo: [f64; 3], mean_free_path_mm: [f64; 3], eta: f64) -> Self {
        let mut out = medium([0.0; 3], [0.0; 3]);
        for c in 0..3 {
            let alpha = diffuse_to_reduced_albedo(albedo[c].clamp(0.001, 0.99), eta);
            // σ_tr = √(3 σ_a σ_t') = σ_t' √(3 (1 − α')).
            let sigma_t = 1.0 / (mean_free_path_mm[c] * (3.0 * (1.0 - alpha)).sqrt());
            out.sigma_s[c] = alpha * sigma_t;
            out.sigma_a[c] = (1.0 - alpha) * sigma_t;
        }
        out
    }

    /// Transport mean free path 1/σ_t' in mm of channel `c`.
    #[must_use]
    pub fn mean_free_path_mm(&self, c: usize) -> f64 {
        1.0 / (self.sigma_s[c] + self.sigma_a[c])
    }

    /// Decay length 1/σ_tr = 1/√(3 σ_a σ_t') in mm of channel `c`; infinite without absorption.
    #[must_use]
    pub fn decay_length_mm(&self, c: usize) -> f64 {
        1.0 / (3.0 * self.sigma_a[c] * (self.sigma_s[c] + self.sigma_a[c])).sqrt()
    }
}

/// Diffuse albedo of a half-space with reduced albedo `alpha` = σ_s'/σ_t' under a collimated beam, in the diffusion
/// approximation: the zero-frequency value of [`super::analytic::HalfSpace::spectrum`].
#[must_use]
pub fn reduced_albedo_to_diffuse(alpha: f64, eta: f64) -> f64 {
    let s = (3.0 * (1.0 - alpha)).sqrt();
    alpha / ((1.0 + s) * (1.0 + 2.0 / 3.0 * boundary_a(eta) * s))
}

/// Inverse of [`reduced_albedo_to_diffuse`], by bisection: the function rises strictly from 0 to 1.
fn diffuse_to_reduced_albedo(albedo: f64, eta: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if reduced_albedo_to_diffuse(middle, eta) < albedo {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
