// Storage of a log-scale profile for every pixel (Song et al. 2009).

// Layer 3 h + c holds node h of channel c; natural log of P in mm^-2.
@group(0) @binding(1) var profiles: texture_2d_array<f32>;

struct Pixel {
    // Column and row.
    texel: vec2<u32>,
}

// The pixel at a texel of the patch.
fn load_pixel(texel: vec2<u32>) -> Pixel {
    return Pixel(texel);
}

// A pixel as a flat varying, from its texel.
fn pack_pixel(texel: vec2<u32>) -> vec4<u32> {
    return vec4<u32>(texel, 0u, 0u);
}

// The pixel of a flat varying.
fn unpack_pixel(pack_pixel: vec4<u32>) -> Pixel {
    return Pixel(pack_pixel.xy);
}

// Node h of the profile of a pixel.
fn node(texel: vec2<u32>, h: u32) -> vec3<f32> {
    let layer = 3u * h;
    return vec3<f32>(
        textureLoad(profiles, texel, layer, 0).x,
        textureLoad(profiles, texel, layer + 1u, 0).x,
        textureLoad(profiles, texel, layer + 2u, 0).x,
    );
}

// Log-scale profile of a pixel.
fn log_profile(pixel: Pixel, knot: Knot) -> vec3<f32> {
    return mix(node(pixel.texel, knot.h), node(pixel.texel, knot.h + 1u), knot.w);
}
