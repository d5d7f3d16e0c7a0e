//! Twin of `fresnel.wgsl`, and the mean of it that uniforms carry.

/// Share of unpolarised light that passes from air into a dielectric of index `eta` at an angle of incidence whose
/// cosine is `cosine`, 0 to 1.
#[must_use]
pub fn fresnel_transmittance(cosine: f32, eta: f32) -> f32 {
    // Along the surface, without a boundary, it would be 0 / 0.
    let cos_i = cosine.max(1e-3);
    let sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    let cos_t = (1.0 - sin2_t).sqrt();
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    1.0 - 0.5 * (parallel * parallel + perpendicular * perpendicular)
}

/// 1 − F_dr from outside: 2 ∫ F_t(cos θ) cos θ d cos θ, by the midpoint rule.
#[must_use]
pub fn diffuse_transmittance(eta: f32) -> f32 {
    const STEPS: u16 = 1_024;
    let terms = (0..STEPS).map(|k| {
        let cosine = (f32::from(k) + 0.5) / f32::from(STEPS);
        2.0 * fresnel_transmittance(cosine, eta) * cosine
    });
    terms.sum::<f32>() / f32::from(STEPS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        // ((η − 1)/(η + 1))² = 0.04 is reflected at normal incidence, everything at grazing incidence.
        assert!((fresnel_transmittance(1.0, 1.5) - 0.96).abs() < 1e-6, "normal incidence");
        assert!(fresnel_transmittance(0.0, 1.5).abs() < 6e-3, "grazing incidence");
        assert!((fresnel_transmittance(0.0, 1.0) - 1.0).abs() < 1e-2, "no boundary, along the surface");
        assert!((fresnel_transmittance(0.3, 1.0) - 1.0).abs() < 1e-6, "no boundary");
        // Brewster's angle: only perpendicular light is reflected, ((η² − 1)/(η² + 1))² of it.
        let brewster = 1.5_f32.atan().cos();
        let expected = 1.0 - 0.5 * (1.25_f32 / 3.25).powi(2);
        assert!((fresnel_transmittance(brewster, 1.5) - expected).abs() < 1e-6, "Brewster");
        // Walsh (1926): F_dr of η = 1.5 from outside is 0.0918.
        assert!((diffuse_transmittance(1.5) - (1.0 - 0.0918)).abs() < 2e-4, "{}", diffuse_transmittance(1.5));
    }
}
