// 1-BMPP: one base material per pixel (Yatagawa et al. 2020, eq. 4 with K = 1).

// Base-material indices.
@group(0) @binding(2) var indices: texture_2d<u32>;

struct Pixel {
    base: vec2<u32>,
}

fn load_pixel(texel: vec2<u32>) -> Pixel {
    return Pixel(base_texel(textureLoad(indices, texel, 0).x));
}

// What a vertex hands to its fragments of the pixel at a texel.
fn carried(texel: vec2<u32>) -> vec4<u32> {
    return vec4<u32>(load_pixel(texel).base, 0u, 0u);
}

// And what they make of it.
fn handed_over(carried: vec4<u32>) -> Pixel {
    return Pixel(carried.xy);
}

fn log_profile(pixel: Pixel, knot: Knot) -> vec3<f32> {
    return base_profile(pixel.base, knot);
}
