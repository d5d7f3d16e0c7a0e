// Exitance from blurred maps: M = sum over m of c_m sum over l and a of w_lma [G_a * (c_l E)], times pitch^2.

struct Combine {
    // w_lma pitch^2, shape [L][L][A]; rgb.
    weights: array<vec4<f32>, 128>,
    // L and A.
    terms: u32,
    gaussians: u32,
    pad: vec2<u32>,
}

@group(0) @binding(0) var<uniform> sum_of: Combine;
// c_l of every pixel; linear rgb, mm^-1.
@group(0) @binding(1) var coefficients: texture_2d_array<f32>;
// G_a * (c_l E), a fastest.
@group(0) @binding(2) var blurred: texture_2d_array<f32>;

@fragment
fn combine(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = vec2<u32>(at.xy);
    var exitance = vec3<f32>(0.0);
    for (var m = 0u; m < sum_of.terms; m++) {
        var light = vec3<f32>(0.0);
        for (var l = 0u; l < sum_of.terms; l++) {
            for (var a = 0u; a < sum_of.gaussians; a++) {
                let weight = sum_of.weights[min((l * sum_of.terms + m) * sum_of.gaussians + a, 127u)].xyz;
                light += weight * textureLoad(blurred, texel, l * sum_of.gaussians + a, 0).xyz;
            }
        }
        exitance += light * textureLoad(coefficients, texel, m, 0).xyz;
    }
    return vec4<f32>(exitance, 1.0);
}
