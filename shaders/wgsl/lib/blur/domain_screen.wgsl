// Domain of blurs on the screen: distances are those in space, from pixels and depth.

// c_l E, blurred by the stages before; depth in mm in the fourth channel.
@group(0) @binding(2) var maps: TargetMaps;

// Most taps to one side, close to the eye.
const MOST_TAPS: f32 = 16.0;
// Most that a slope makes a tap count: steeper ones are seen by chance.
const MOST_STRETCH: f32 = 5.0;

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

// Distance of taps in mm.
fn tap_mm(taps: Taps) -> f32 {
    return f32(taps.stride) * stage.step * domain.pitch_mm / taps.sigma;
}

// How far slopes can be told from depths, 0 to 1: half floats have steps of up to 1/1024 of a depth, which have to be less than an
// eighth of the distance of taps; from a half of it on, surfaces count as planes that face the eye.
fn steadiness(taps: Taps, depth: f32) -> f32 {
    let step = abs(depth) / (1024.0 * tap_mm(taps));
    return clamp((0.5 - step) / 0.375, 0.0, 1.0);
}

// Length of the curve that a tap stands for, along which the surface lies, by its length across the view; of the depths of the tap
// before, of this one and of the next. Where the surface ends, the change to one side tells nothing of its slope: it is the mean of
// both, at most twice the smaller (van Leer 1977).
fn arc_of(taps: Taps, steady: f32, depths: vec3<f32>) -> f32 {
    let change = depths.yz - depths.xy;
    let smaller = min(abs(change.x), abs(change.y));
    let slope = min(0.5 * abs(change.x + change.y), 2.0 * smaller) / tap_mm(taps);
    return mix(1.0, min(sqrt(1.0 + slope * slope), MOST_STRETCH), steady);
}

// What to divide a weighted sum by. The weights of a plane as steep as the middle tap, `stretch`, add up to `of_plane`; those of a
// surface that curves away to less: what the eye does not see of it is taken to be half as bright. The narrowest Gaussian does not
// reach around anything.
fn whole_of(taps: Taps, steady: f32, weights: f32, stretch: f32) -> f32 {
    // Of taps that are far apart only the middle one and its neighbours count; of others the sum is close to the integral.
    let distances = taps.sigma / (f32(taps.stride) * stretch);
    let few = 1.0 + 2.0 * exp(-0.5 * min(1.0 / (distances * distances), 80.0));
    let of_plane = stretch * select(2.5066283 * distances, few, distances < 0.6);
    let share = select(0.5 * steady, 0.0, stage.has_sum == 0u);
    return weights * pow(of_plane / weights, share);
}

// All maps, blurred at texel x; the fourth channel keeps its depth.
fn blurred(x: vec2<i32>) -> array<vec4<f32>, TERMS> {
    let centre = maps_at(x)[0];
    var sums: array<vec4<f32>, TERMS>;
    if centre.w > BACKGROUND_MM {
        sums[0].w = centre.w;
        return sums;
    }
    let taps = taps_at(centre);
    let next = taps.stride * stage.axis;
    let first = x - taps.count * next;
    var before = load_map(maps, within(first - next), 0u).w;
    var light = maps_at(first);
    let steady = steadiness(taps, centre.w);
    var weights = 0.0;
    var stretch = 1.0;
    for (var k = -taps.count; k <= taps.count; k++) {
        var after = maps_at(x + (k + 1) * next);
        let arc = arc_of(taps, steady, vec3<f32>(before, light[0].w, after[0].w));
        stretch = select(stretch, arc, k == 0);
        let distance = f32(k * taps.stride) / taps.sigma;
        let weight = exp(-0.5 * distance * distance) * nearness(centre, light[0]) * arc;
        weights += weight;
        for (var l = 0u; l < TERMS; l++) {
            sums[l] += weight * light[l];
        }
        before = light[0].w;
        light = after;
    }
    let whole = whole_of(taps, steady, weights, stretch);
    for (var l = 0u; l < TERMS; l++) {
        sums[l] = vec4<f32>(sums[l].xyz / whole, centre.w);
    }
    return sums;
}

// Whether there is a sum to add to: always, it begins with the transmitted light.
fn has_sum() -> bool {
    return true;
}

// Texel x, clamped to the maps.
fn within(x: vec2<i32>) -> vec2<i32> {
    return clamp(x, vec2<i32>(0), vec2<i32>(domain.size) - 1);
}

// All maps at texel x, clamped to their size.
fn maps_at(x: vec2<i32>) -> array<vec4<f32>, TERMS> {
    let texel = within(x);
    var all: array<vec4<f32>, TERMS>;
    for (var l = 0u; l < TERMS; l++) {
        all[l] = load_map(maps, texel, l);
    }
    return all;
}
