// c_l E: irradiance, weighted by one factor of the material.

// c_l of every pixel; linear rgb, mm^-1.
@group(0) @binding(0) var coefficients: texture_2d_array<f32>;
// Irradiance that has entered the material; linear rgb.
@group(0) @binding(1) var irradiance: texture_2d<f32>;

struct Term {
    // l.
    layer: u32,
    pad_0: u32,
    pad_1: vec2<u32>,
}

@group(0) @binding(2) var<uniform> term: Term;

@fragment
fn weigh(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = vec2<u32>(at.xy);
    let c = textureLoad(coefficients, texel, term.layer, 0).xyz;
    return vec4<f32>(c * textureLoad(irradiance, texel, 0).xyz, 1.0);
}
