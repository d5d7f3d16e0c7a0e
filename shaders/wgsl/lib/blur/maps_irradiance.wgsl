// c_l E on a flat patch: irradiance, weighted by the factors of the material.

// c_l of every pixel; linear rgb, mm^-1.
@group(0) @binding(2) var factors: texture_2d_array<f32>;
// Irradiance that has entered the material; linear rgb.
@group(0) @binding(3) var irradiance: texture_2d<f32>;

fn maps_at(x: vec2<i32>) -> array<vec4<f32>, TERMS> {
    let place = middle_of(x, textureDimensions(irradiance));
    let e = textureSampleLevel(irradiance, nearest, place, 0.0).xyz;
    var all: array<vec4<f32>, TERMS>;
    for (var l = 0u; l < TERMS; l++) {
        all[l] = vec4<f32>(textureSampleLevel(factors, nearest, place, l, 0.0).xyz * e, 0.0);
    }
    return all;
}
