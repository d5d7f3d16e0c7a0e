// Irradiance maps of a flat patch before the first stage: c_l E.

// c_l of every pixel; linear Rec. 709, mm^-1.
@group(0) @binding(2) var coefficients: texture_2d_array<f32>;
// Irradiance that has entered the material, of every pixel; linear Rec. 709.
@group(0) @binding(3) var irradiance: texture_2d<f32>;

// All maps at texel x, or beyond the border.
fn maps_at(x: vec2<i32>) -> array<vec4<f32>, TERMS> {
    let texel = addressed(x);
    let e = textureLoad(irradiance, min(texel, textureDimensions(irradiance) - 1u), 0).xyz;
    var all: array<vec4<f32>, TERMS>;
    for (var l = 0u; l < TERMS; l++) {
        all[l] = vec4<f32>(textureLoad(coefficients, texel, l, 0).xyz * e, 0.0);
    }
    return all;
}
