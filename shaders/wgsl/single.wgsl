// 1-BMPP: one base material per pixel (Yatagawa et al. 2020, eq. 4 with K = 1).

// Base-material indices.
@group(0) @binding(2) var indices: texture_2d<u32>;

struct Pixel {
    base: vec2<u32>,
}

fn load_pixel(texel: vec2<u32>) -> Pixel {
    return Pixel(base_texel(textureLoad(indices, texel, 0).x));
}

fn log_profile(pixel: Pixel, knot: Knot) -> vec3<f32> {
    return base_profile(pixel.base, knot);
}
