// 2-BMPP: a mixture of two base materials per pixel (Yatagawa et al. 2020, eq. 4 with K = 2).

struct Pixel {
    // Texels of node 0 of both base materials.
    first: vec2<u32>,
    second: vec2<u32>,
    // Mixture ratio of the first one, 0 to 1.
    t: f32,
}

// A pixel as a flat varying, from its texel: coordinates of base materials fit 16 bits.
fn pack_pixel(texel: vec2<u32>) -> vec4<u32> {
    let pixel = load_pixel(texel);
    let places = vec2<u32>(pixel.first.x, pixel.second.x) | (vec2<u32>(pixel.first.y, pixel.second.y) << vec2<u32>(16u));
    return vec4<u32>(places, bitcast<u32>(pixel.t), 0u);
}

// The pixel of a flat varying.
fn unpack_pixel(pack_pixel: vec4<u32>) -> Pixel {
    let first = vec2<u32>(pack_pixel.x & 0xffffu, pack_pixel.x >> 16u);
    let second = vec2<u32>(pack_pixel.y & 0xffffu, pack_pixel.y >> 16u);
    return Pixel(first, second, bitcast<f32>(pack_pixel.z));
}

// P_x = t P_b1 + (1 - t) P_b2, all in log scale.
fn log_profile(pixel: Pixel, knot: Knot) -> vec3<f32> {
    return mix(base_profile(pixel.second, knot), base_profile(pixel.first, knot), pixel.t);
}
