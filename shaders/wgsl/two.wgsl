// A blend of two base materials (Yatagawa et al. 2020, eq. 4 with K = 2).

struct Pixel {
    first: vec2<u32>,
    second: vec2<u32>,
    // Mixture ratio of the first base material.
    t: f32,
}

// P_x = t P_b1 + (1 - t) P_b2, all in log scale.
fn log_profile(pixel: Pixel, knot: Knot) -> vec3<f32> {
    return mix(base_profile(pixel.second, knot), base_profile(pixel.first, knot), pixel.t);
}
