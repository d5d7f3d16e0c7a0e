// K-BMPP with K = PER_PIXEL > 2: a mixture of K base materials per pixel (Yatagawa et al. 2020, eq. 4).

// Mixture ratios, 0 to 1, a layer for each base material of a pixel.
@group(0) @binding(2) var ratios: texture_2d_array<f32>;
// Base-material indices, likewise.
@group(0) @binding(3) var indices: texture_2d_array<u32>;

struct Pixel {
    // Texels of node 0 of the base materials.
    bases: array<vec2<u32>, PER_PIXEL>,
    // Mixture ratios.
    t: array<f32, PER_PIXEL>,
}

// The pixel at a texel of the patch.
fn load_pixel(texel: vec2<u32>) -> Pixel {
    var pixel: Pixel;
    for (var k = 0u; k < PER_PIXEL; k++) {
        pixel.bases[k] = base_texel(textureLoad(indices, texel, k, 0).x);
        pixel.t[k] = textureLoad(ratios, texel, k, 0).x;
    }
    return pixel;
}

// A pixel as a flat varying: its texel, for the pixel itself is too large.
fn pack_pixel(texel: vec2<u32>) -> vec4<u32> {
    return vec4<u32>(texel, 0u, 0u);
}

// The pixel of a flat varying.
fn unpack_pixel(pack_pixel: vec4<u32>) -> Pixel {
    return load_pixel(pack_pixel.xy);
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
