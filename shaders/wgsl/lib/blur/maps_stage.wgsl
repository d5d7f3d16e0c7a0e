// Irradiance maps of a flat patch after the stages before: c_l E, blurred.

@group(0) @binding(2) var maps: FloatMaps;

// All maps at texel x, wrapped by the sampler.
fn maps_at(x: vec2<i32>) -> array<vec4<f32>, TERMS> {
    let uv = middle_of(x, textureDimensions(maps));
    var all: array<vec4<f32>, TERMS>;
    for (var l = 0u; l < TERMS; l++) {
        all[l] = sample_map(maps, nearest, uv, l);
    }
    return all;
}
