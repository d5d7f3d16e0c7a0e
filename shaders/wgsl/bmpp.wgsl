// 2-BMPP: two base materials per pixel (Yatagawa et al. 2020, eq. 1-4).

// S x M, log-scale base scattering profiles: node across, material down, rgb in a texel.
@group(0) @binding(1) var profiles: texture_2d<f32>;
// Mixture ratio t of the first base material.
@group(0) @binding(2) var ratios: texture_2d<f32>;
// Base-material indices.
@group(0) @binding(3) var indices: texture_2d<u32>;

struct Pixel {
    base: vec2<u32>,
    t: f32,
}

fn load_pixel(texel: vec2<u32>) -> Pixel {
    let base = textureLoad(indices, texel, 0).xy;
    let t = textureLoad(ratios, texel, 0).x;
    return Pixel(min(base, vec2<u32>(material.base_materials - 1u)), t);
}

fn base_node(base: u32, h: u32) -> vec3<f32> {
    return textureLoad(profiles, vec2<u32>(h, base), 0).xyz;
}

fn base_profile(base: u32, knot: Knot) -> vec3<f32> {
    return mix(base_node(base, knot.h), base_node(base, knot.h + 1u), knot.w);
}

// P_x = t P_b1 + (1 - t) P_b2, all in log scale.
fn log_profile(pixel: Pixel, knot: Knot) -> vec3<f32> {
    return mix(base_profile(pixel.base.y, knot), base_profile(pixel.base.x, knot), pixel.t);
}
