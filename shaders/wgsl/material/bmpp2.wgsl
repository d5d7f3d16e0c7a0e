// A blend of two base materials (Yatagawa et al. 2020, eq. 4 with K = 2).

struct Pixel {
    first: vec2<u32>,
    second: vec2<u32>,
    // Mixture ratio of the first base material.
    t: f32,
}

// What a vertex hands to its fragments of the pixel at a texel: places of base materials fit 16 bits.
fn carried(texel: vec2<u32>) -> vec4<u32> {
    let pixel = load_pixel(texel);
    let places = vec2<u32>(pixel.first.x, pixel.second.x) | (vec2<u32>(pixel.first.y, pixel.second.y) << vec2<u32>(16u));
    return vec4<u32>(places, bitcast<u32>(pixel.t), 0u);
}

// And what they make of it.
fn handed_over(carried: vec4<u32>) -> Pixel {
    let first = vec2<u32>(carried.x & 0xffffu, carried.x >> 16u);
    let second = vec2<u32>(carried.y & 0xffffu, carried.y >> 16u);
    return Pixel(first, second, bitcast<f32>(carried.z));
}

// P_x = t P_b1 + (1 - t) P_b2, all in log scale.
fn log_profile(pixel: Pixel, knot: Knot) -> vec3<f32> {
    return mix(base_profile(pixel.second, knot), base_profile(pixel.first, knot), pixel.t);
}
