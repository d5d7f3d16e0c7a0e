// 1-BMPP: one base material per pixel (Yatagawa et al. 2020, eq. 4 with K = 1).

// Base-material indices.
@group(0) @binding(2) var indices: texture_2d<u32>;

struct Pixel {
    // Texel of node 0 of the base material.
    base: vec2<u32>,
}

// The pixel at a texel of the patch.
fn load_pixel(texel: vec2<u32>) -> Pixel {
    return Pixel(base_texel(textureLoad(indices, texel, 0).x));
}

// A pixel as a flat varying, from its texel.
fn pack_pixel(texel: vec2<u32>) -> vec4<u32> {
    return vec4<u32>(load_pixel(texel).base, 0u, 0u);
}

// The pixel of a flat varying.
fn unpack_pixel(pack_pixel: vec4<u32>) -> Pixel {
    return Pixel(pack_pixel.xy);
}

// Log-scale profile of a pixel.
fn log_profile(pixel: Pixel, knot: Knot) -> vec3<f32> {
    return base_profile(pixel.base, knot);
}
