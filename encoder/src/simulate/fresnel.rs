//! Reflection at the boundary of a dielectric, at an angle and averaged over directions.

/// Fresnel's reflectance F_r of unpolarised light at a boundary across which refractive indices have the ratio `eta` =
/// η_here / η_there, at an angle to the normal whose cosine here is `cosine`, 0 to 1; 1 beyond the critical angle.
#[must_use]
pub fn reflectance(eta: f64, cosine: f64) -> f64 {
    let sin2_there = eta * eta * (1.0 - cosine * cosine);
    if sin2_there >= 1.0 {
        return 1.0;
    }
    let there = (1.0 - sin2_there).sqrt();
    let perpendicular = (eta * cosine - there) / (eta * cosine + there);
    let parallel = (cosine - eta * there) / (cosine + eta * there);
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}

/// Diffuse Fresnel reflectance F_dr inside a medium of refractive index `eta` ≥ 1 against air: Fresnel's reflectance of
/// unpolarised light, 2 ∫ F_r(cos θ) cos θ d cos θ.
///
/// Walsh (1926) has the integral from outside; inside, η² times less is transmitted.
#[must_use]
pub fn diffuse_reflectance(eta: f64) -> f64 {
    // Nothing is reflected where there is no boundary; the terms below would be differences of infinities.
    if eta < 1.0 + 1e-4 {
        return 0.0;
    }
    let n = eta;
    let (n2, n3, n4) = (n * n, n * n * n, n * n * n * n);
    let outside = 0.5
        + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0).powi(2))
        + n2 * (n2 - 1.0).powi(2) / (n2 + 1.0).powi(3) * ((n - 1.0) / (n + 1.0)).ln()
        - 2.0 * n3 * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
        + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0).powi(2)) * n.ln();
    1.0 - (1.0 - outside) / n2
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
    fn is_the_mean_of_fresnels_reflectance() {
        const STEPS: u32 = 20_000;
        for eta in [1.0, 1.0002, 1.05, 1.33, 1.5, 2.0, 4.0] {
            let cosines = (0..STEPS).map(|k| (f64::from(k) + 0.5) / f64::from(STEPS));
            let mean = cosines.map(|cosine| 2.0 * reflectance(eta, cosine) * cosine).sum::<f64>() / f64::from(STEPS);
            assert!((diffuse_reflectance(eta) - mean).abs() < 1e-4, "{eta}: {} {mean}", diffuse_reflectance(eta));
            assert!(boundary_a(eta) >= 1.0 && boundary_a(eta).is_finite(), "A({eta}) = {}", boundary_a(eta));
        }
    }
}
