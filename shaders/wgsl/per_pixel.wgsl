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

// What pixel o contributes to every pair at distance r.
struct Partner {
    knot: Knot,
    log_profile: vec3<f32>,
}

fn partner_at(o: Pixel, r_mm: f32) -> Partner {
    let knot = knot_at(r_mm);
    return Partner(knot, log_profile(o, knot));
}

// Rd in mm^-2 from pixel i to o, the partner at their distance; step = x_i - x_o in pixels.
fn reflectance(i: Pixel, o: Partner, step: vec2<i32>) -> vec3<f32> {
    return exp(0.5 * (log_profile(i, o.knot) + o.log_profile));
}
