// Factors of the material: c_l in mm^-1, a layer each, and the albedo under uniform light in the layer after them.

const FACTORS: u32 = TERMS + 1u;

// All c_l, and the albedo last.
fn factors_at(p: vec3<f32>, n: vec3<f32>, uv: vec2<f32>, change: Step) -> array<vec3<f32>, FACTORS> {
    var all: array<vec3<f32>, FACTORS>;
    for (var l = 0u; l < FACTORS; l++) {
        all[l] = layer_at(l, p, n, uv, change);
    }
    return all;
}
