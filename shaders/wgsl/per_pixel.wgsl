// A profile for every pixel (Song et al. 2009).

// Layer 3 h + c holds node h of channel c.
@group(0) @binding(1) var profiles: texture_2d_array<f32>;

struct Pixel {
    texel: vec2<u32>,
}

fn load_pixel(texel: vec2<u32>) -> Pixel {
    return Pixel(texel);
}

fn node(texel: vec2<u32>, h: u32) -> vec3<f32> {
    let layer = 3u * h;
    return vec3<f32>(
        textureLoad(profiles, texel, layer, 0).x,
        textureLoad(profiles, texel, layer + 1u, 0).x,
        textureLoad(profiles, texel, layer + 2u, 0).x,
    );
}

fn log_profile(pixel: Pixel, knot: Knot) -> vec3<f32> {
    return mix(node(pixel.texel, knot.h), node(pixel.texel, knot.h + 1u), knot.w);
}
