//! Reflection at the boundary of a dielectric, averaged over directions.

/// Diffuse Fresnel reflectance F_dr inside a medium of refractive index `eta` ≥ 1 against air: Fresnel's reflectance of
/// unpolarised light, 2 ∫ F_r(cos θ) cos θ d cos θ, by the midpoint rule.
#[must_use]
pub fn diffuse_reflectance(eta: f64) -> f64 {
    const STEPS: u32 = 4_096;
    let terms = (0..STEPS).map(|k| {
        let cosine = (f64::from(k) + 0.5) / f64::from(STEPS);
        2.0 * reflectance(cosine, eta) * cosine
    });
    terms.sum::<f64>() / f64::from(STEPS)
}

/// Reflectance inside the medium at an angle whose cosine is `cos_i`; 1 beyond the critical angle.
fn reflectance(cos_i: f64, eta: f64) -> f64 {
    let sin2_t = eta * eta * (1.0 - cos_i * cos_i);
    if sin2_t >= 1.0 {
        return 1.0;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}

/// A = (1 + F_dr) / (1 − F_dr) of the partial-current boundary φ = 2 A D ∂φ/∂z (Jensen et al. 2001).
#[must_use]
pub fn boundary_a(eta: f64) -> f64 {
    let f_dr = diffuse_reflectance(eta);
    (1.0 + f_dr) / (1.0 - f_dr)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        // Walsh (1926): 0.0918 from outside at η = 1.5; inside, 1 − F_dr is η² times less.
        let from_outside = 1.0 - (1.0 - 0.0918) / 2.25;
        assert!((diffuse_reflectance(1.5) - from_outside).abs() < 1e-4, "{}", diffuse_reflectance(1.5));
        assert!(diffuse_reflectance(1.0).abs() < 1e-12, "no boundary");
        for eta in [1.0, 1.33, 2.0, 4.0] {
            assert!(boundary_a(eta) >= 1.0 && boundary_a(eta).is_finite(), "A({eta}) = {}", boundary_a(eta));
        }
    }
}
