// A profile for every pixel (Song et al. 2009).

// Layer 3 h + c holds node h of channel c.
@group(0) @binding(1) var profiles: texture_2d_array<f32>;

struct Pixel {
    texel: vec2<u32>,
}

fn load_pixel(texel: vec2<u32>) -> Pixel {
    return Pixel(texel);
}

// What a vertex hands to its fragments of the pixel at a texel.
fn carried(texel: vec2<u32>) -> vec4<u32> {
    return vec4<u32>(texel, 0u, 0u);
}

// And what they make of it.
fn handed_over(carried: vec4<u32>) -> Pixel {
    return Pixel(carried.xy);
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
