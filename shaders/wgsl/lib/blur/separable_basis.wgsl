// Coefficients of the separable basis at a point of a surface: c_l in mm^-1, a layer each, and the albedo in the layer after
// them.

const LAYERS: u32 = TERMS + 1u;

// All c_l and, last, the albedo under uniform light, at a fragment.
fn basis_at(at: Lookup) -> array<vec3<f32>, LAYERS> {
    var all: array<vec3<f32>, LAYERS>;
    for (var l = 0u; l < LAYERS; l++) {
        all[l] = layer_at(l, at);
    }
    return all;
}
