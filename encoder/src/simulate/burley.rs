//! Normalised diffusion: a profile fitted to Monte Carlo, in closed form.

use std::f64::consts::PI;

/// Normalised diffusion of one channel under a thin beam (Christensen and Burley 2015, *Approximate reflectance profiles for efficient
/// subsurface scattering*; Burley 2015).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalisedDiffusion {
    /// Diffuse albedo A, which is ‖R_d‖₁; 0 to 1.
    pub albedo: f64,
    /// Mean free path ℓ = 1/σ_t' in mm.
    pub mean_free_path_mm: f64,
}

impl NormalisedDiffusion {
    /// ℓ / s in mm, with s = 1.85 − A + 7 |A − 0.8|³ for a beam along the normal (Christensen and Burley 2015, eq. 5).
    #[must_use]
    pub fn length_mm(&self) -> f64 {
        let a = self.albedo;
        self.mean_free_path_mm / (1.85 - a + 7.0 * (a - 0.8).abs().powi(3))
    }

    /// R_d(r) = A s (e^(−sr/ℓ) + e^(−sr/3ℓ)) / (8π ℓ r) in mm⁻² (eq. 3); infinite at 0.
    #[must_use]
    pub fn rd(&self, r_mm: f64) -> f64 {
        let length = self.length_mm();
        let x = r_mm / length;
        self.albedo * ((-x).exp() + (-x / 3.0).exp()) / (8.0 * PI * length * r_mm)
    }

    /// T(d) = ∫_d^∞ R_d(r) 2πr dr = A (e^(−sd/ℓ) + 3 e^(−sd/3ℓ)) / 4.
    #[must_use]
    pub fn tail(&self, d_mm: f64) -> f64 {
        let x = d_mm / self.length_mm();
        self.albedo * 0.25 * ((-x).exp() + 3.0 * (-x / 3.0).exp())
    }
}
