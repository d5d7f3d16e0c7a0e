// Blur of all irradiance maps by one stage of the cascade of Gaussians, along one axis.

struct BlurStage {
    // w_lma of this stage's a, shape [l][m]; linear Rec. 709.
    weights: array<vec4<f32>, 4>,
    // (1, 0) or (0, 1).
    axis: vec2<i32>,
    // On a flat patch: standard deviation and distance of taps in pixels; taps to each side.
    sigma: f32,
    stride: i32,
    taps: i32,
    // On the screen: standard deviation of this stage, and distance of taps that the blur so far allows, in pixels of the
    // material.
    step: f32,
    sparse: f32,
    // 1 if there is a sum of earlier stages, 0 for the first.
    has_sum: u32,
}

@group(0) @binding(0) var<uniform> stage: BlurStage;

// Taps at k stride texels, |k| <= count; sigma in texels.
struct Taps {
    stride: i32,
    count: i32,
    sigma: f32,
}

// All maps, blurred at texel x; the fourth channel of the first keeps its depth.
fn blurred(x: vec2<i32>) -> array<vec4<f32>, TERMS> {
    let centre = maps_at(x)[0];
    var sums: array<vec4<f32>, TERMS>;
    // Depth of the background is beyond everything.
    if centre.w > 50000.0 {
        sums[0].w = centre.w;
        return sums;
    }
    let taps = taps_at(centre);
    let next = taps.stride * stage.axis;
    var before = depth_at(x - (taps.count + 1) * next);
    var weights = 0.0;
    var stretch = 1.0;
    for (var k = -taps.count; k <= taps.count; k++) {
        let at = x + k * next;
        var light = maps_at(at);
        let arc = arc_of(taps, vec3<f32>(before, light[0].w, depth_at(at + next)));
        before = light[0].w;
        stretch = select(stretch, arc, k == 0);
        let distance = f32(k * taps.stride) / taps.sigma;
        let weight = exp(-0.5 * distance * distance) * nearness(centre, light[0]) * arc;
        weights += weight;
        for (var l = 0u; l < TERMS; l++) {
            sums[l] += weight * light[l];
        }
    }
    let whole = whole_of(taps, weights, stretch);
    for (var l = 0u; l < TERMS; l++) {
        sums[l] = vec4<f32>(sums[l].xyz / whole, centre.w);
    }
    return sums;
}
