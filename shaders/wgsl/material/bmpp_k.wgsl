// K-BMPP with K = PER_PIXEL > 2 (Yatagawa et al. 2020, eq. 4).

// Mixture ratios, a layer for each base material of a pixel.
@group(0) @binding(2) var ratios: texture_2d_array<f32>;
// Base-material indices, likewise.
@group(0) @binding(3) var indices: texture_2d_array<u32>;

struct Pixel {
    bases: array<vec2<u32>, PER_PIXEL>,
    t: array<f32, PER_PIXEL>,
}

fn load_pixel(texel: vec2<u32>) -> Pixel {
    var pixel: Pixel;
    for (var k = 0u; k < PER_PIXEL; k++) {
        pixel.bases[k] = base_texel(textureLoad(indices, texel, k, 0).x);
        pixel.t[k] = textureLoad(ratios, texel, k, 0).x;
    }
    return pixel;
}

// What a vertex hands to its fragments of the pixel at a texel: too much for all of it.
fn carried(texel: vec2<u32>) -> vec4<u32> {
    return vec4<u32>(texel, 0u, 0u);
}

// And what they make of it.
fn handed_over(carried: vec4<u32>) -> Pixel {
    return load_pixel(carried.xy);
}

// P_x = sum of t_k P_bk, all in log scale.
fn log_profile(pixel: Pixel, knot: Knot) -> vec3<f32> {
    // Only variables can be indexed by what is not constant.
    var parts = pixel;
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < PER_PIXEL; k++) {
        sum += parts.t[k] * base_profile(parts.bases[k], knot);
    }
    return sum;
}
