// Coefficients of the separable basis at a point of a surface: c_l in mm^-1, a layer each, and the albedo in the layer after
// them.

const LAYERS: u32 = TERMS + 1u;

// All c_l and, last, the albedo under uniform light, at a point p in mm of normal n.
fn basis_at(p: vec3<f32>, n: vec3<f32>, uv: vec2<f32>, slopes: Derivatives) -> array<vec3<f32>, LAYERS> {
    var all: array<vec3<f32>, LAYERS>;
    for (var l = 0u; l < LAYERS; l++) {
        all[l] = layer_at(l, p, n, uv, slopes);
    }
    return all;
}
