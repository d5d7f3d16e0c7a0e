// c_l E on a flat patch: irradiance, weighted by the factors of the material.

// c_l of every pixel; linear rgb, mm^-1.
@group(0) @binding(0) var factors: texture_2d_array<f32>;
// Irradiance that has entered the material; linear rgb.
@group(0) @binding(1) var irradiance: texture_2d<f32>;

@fragment
fn weigh(@builtin(position) at: vec4<f32>) -> Maps {
    let texel = vec2<u32>(at.xy);
    let e = textureLoad(irradiance, texel, 0).xyz;
    var maps: array<vec4<f32>, TERMS>;
    for (var l = 0u; l < TERMS; l++) {
        maps[l] = vec4<f32>(textureLoad(factors, texel, l, 0).xyz * e, 0.0);
    }
    return maps_of(maps);
}
