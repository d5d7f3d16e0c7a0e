//! Reflection at the boundary of a dielectric, averaged over directions.

/// Diffuse Fresnel reflectance F_dr inside a medium of refractive index `eta` against air (Egan and Hilgeman 1979, as
/// in Jensen et al. 2001).
#[must_use]
pub fn diffuse_reflectance(eta: f64) -> f64 {
    -1.4399 / (eta * eta) + 0.7099 / eta + 0.6681 + 0.0636 * eta
}

/// A = (1 + F_dr) / (1 − F_dr) of the partial-current boundary φ = 2 A D ∂φ/∂z (Jensen et al. 2001).
#[must_use]
pub fn boundary_a(eta: f64) -> f64 {
    let f_dr = diffuse_reflectance(eta);
    (1.0 + f_dr) / (1.0 - f_dr)
}
