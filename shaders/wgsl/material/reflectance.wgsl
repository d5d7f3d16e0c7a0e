// Diffuse reflectance of a pair of pixels from their log-scale profiles (Yatagawa et al. 2020, eq. 2).

// Share of pixel o in its pairs at distance r.
struct Partner {
    knot: Knot,
    log_profile: vec3<f32>,
}

// Share of pixel o at a distance in mm.
fn partner_at(o: Pixel, r_mm: f32) -> Partner {
    let knot = knot_at(r_mm);
    return Partner(knot, log_profile(o, knot));
}

// Share of two pixels of which the first is a partner already: f = exp(P / 2) is blended, `share` of the first.
fn blended(first: Partner, second: Pixel, share: f32) -> Partner {
    let f = mix(exp(0.5 * log_profile(second, first.knot)), exp(0.5 * first.log_profile), share);
    return Partner(first.knot, 2.0 * log(max(f, vec3<f32>(1e-30))));
}

// Rd in mm^-2 from pixel i to o, the partner at their distance; step = x_i - x_o in pixels.
fn reflectance(i: Pixel, o: Partner, step: vec2<i32>) -> vec3<f32> {
    return exp(0.5 * (log_profile(i, o.knot) + o.log_profile));
}
