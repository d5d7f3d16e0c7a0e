// Domain of blurs on a flat patch: taps as far apart as the stage has them, texels beyond the border addressed as the patch says.

struct PatchDomain {
    // Pixels of the patch, columns and rows.
    size: vec2<u32>,
    // 0 clamp, 1 repeat, 2 mirror.
    addressing: u32,
    pad: u32,
}

@group(0) @binding(1) var<uniform> domain: PatchDomain;

// Taps of the stage, the same for all texels.
fn taps_at(centre: vec4<f32>) -> Taps {
    // Depth is 0 here. Where nothing but uniforms says when a loop ends, Mesa's software Vulkan compiles it anew at every
    // draw.
    return Taps(stage.stride, stage.taps + i32(centre.w), stage.sigma);
}

// All maps, blurred at texel x.
fn blurred(x: vec2<i32>) -> array<vec4<f32>, TERMS> {
    let taps = taps_at(maps_at(x)[0]);
    var sums: array<vec4<f32>, TERMS>;
    var weights = 0.0;
    for (var k = -taps.count; k <= taps.count; k++) {
        let step = k * taps.stride;
        var light = maps_at(x + step * stage.axis);
        let distance = f32(step) / taps.sigma;
        let weight = exp(-0.5 * distance * distance);
        weights += weight;
        for (var l = 0u; l < TERMS; l++) {
            sums[l] += weight * light[l];
        }
    }
    for (var l = 0u; l < TERMS; l++) {
        sums[l] = vec4<f32>(sums[l].xyz / weights, 0.0);
    }
    return sums;
}

// Whether there is a sum to add to: not at the first stage.
fn has_sum() -> bool {
    return stage.has_sum != 0u;
}

// Pixel of the patch for a texel, or for a tap of it beyond the border.
fn addressed(x: vec2<i32>) -> vec2<u32> {
    let last = vec2<i32>(domain.size) - 1;
    let inside = clamp(x, vec2<i32>(0), last);
    if domain.addressing == 0u || all(inside == x) {
        return vec2<u32>(inside);
    }
    // Mirrored patches repeat after two. Made positive first: GLSL's remainder of negative numbers is another one.
    let period = domain.size * select(1u, 2u, domain.addressing == 2u);
    let m = vec2<u32>(x + vec2<i32>(period) * max(stage.taps * stage.stride, 1)) % period;
    return min(m, select(m, period - 1u - m, domain.addressing == 2u));
}
