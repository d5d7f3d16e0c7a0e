// Domain of blurs on the screen: distances are those in space, from pixels and depth.

// c_l E, blurred by the stages before; depth in mm in the fourth channel.
@group(0) @binding(2) var maps: TargetMaps;

// Most taps to one side, close to the eye.
const MOST_TAPS: f32 = 16.0;

// Taps of the stage at the distance of a texel, whose depth in mm is in the fourth channel.
fn taps_at(centre: vec4<f32>) -> Taps {
    let focal_texels = dot(domain.focal_texels, vec2<f32>(stage.axis));
    let texels_per_pixel = focal_texels / max(domain.middle_mm + domain.perspective * centre.w, 1e-3);
    let sigma = stage.step * texels_per_pixel;
    let sparse = max(floor(stage.sparse * texels_per_pixel), 1.0);
    // What is cut off is close to nothing, until the eye is so close that taps would be too many.
    let taps = clamp(ceil(3.2 * sigma / sparse), 1.0, MOST_TAPS);
    let stride = max(sparse, floor(3.2 * sigma / taps));
    return Taps(i32(stride), i32(taps), max(sigma, 1e-3));
}

// Factor of exp(-r^2 / 2 sigma^2) for the difference of depth (Jimenez et al. 2015, supplement, section E).
fn nearness(centre: vec4<f32>, other: vec4<f32>) -> f32 {
    let d = (other.w - centre.w) / (stage.step * domain.pitch_mm);
    return exp(-0.5 * min(d * d, 80.0));
}

// Whether there is a sum to add to: always, it begins with the transmitted light.
fn has_sum() -> bool {
    return true;
}

// All maps at texel x, clamped to their size.
fn maps_at(x: vec2<i32>) -> array<vec4<f32>, TERMS> {
    let texel = clamp(x, vec2<i32>(0), vec2<i32>(domain.size) - 1);
    var all: array<vec4<f32>, TERMS>;
    for (var l = 0u; l < TERMS; l++) {
        all[l] = load_map(maps, texel, l);
    }
    return all;
}
