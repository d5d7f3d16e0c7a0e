// Fresnel's equations for a smooth dielectric.

// Transmittance of unpolarised light from air into a dielectric of refractive index eta, 0 to 1; `cosine` is that of the
// angle of incidence, 0 to 1.
fn fresnel_transmittance(cosine: f32, eta: f32) -> f32 {
    // Along the surface, without a boundary, it would be 0 / 0.
    let cos_i = max(cosine, 1e-3);
    let sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    let cos_t = sqrt(1.0 - sin2_t);
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return 1.0 - 0.5 * (parallel * parallel + perpendicular * perpendicular);
}
