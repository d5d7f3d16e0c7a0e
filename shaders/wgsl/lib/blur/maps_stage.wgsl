// Irradiance maps of a flat patch after the stages before: c_l E, blurred.

@group(0) @binding(2) var maps: TargetMaps;

// All maps at texel x, or beyond the border.
fn maps_at(x: vec2<i32>) -> array<vec4<f32>, TERMS> {
    let texel = vec2<i32>(addressed(x));
    var all: array<vec4<f32>, TERMS>;
    for (var l = 0u; l < TERMS; l++) {
        all[l] = load_map(maps, texel, l);
    }
    return all;
}
