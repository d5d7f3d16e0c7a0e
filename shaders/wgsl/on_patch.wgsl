// Blurs on a flat patch: taps as far apart as the stage says, wrapped at the border.

struct Domain {
    // Pixels of the patch.
    size: vec2<u32>,
    // 0 clamp, 1 repeat, 2 mirror.
    addressing: u32,
    pad: u32,
}

@group(0) @binding(1) var<uniform> domain: Domain;

fn taps_at(centre: vec4<f32>) -> Taps {
    return Taps(stage.stride, stage.taps, stage.sigma);
}

// The pixel that a coordinate names. Taps beyond the border may be further away than the patch is long.
fn texel_at(x: vec2<i32>) -> vec2<u32> {
    let size = vec2<i32>(domain.size);
    if domain.addressing == 0u {
        return vec2<u32>(clamp(x, vec2<i32>(0), size - 1));
    }
    let period = size * select(1, 2, domain.addressing == 2u);
    // Made positive first: GLSL's remainder of negative numbers is another one.
    let m = (x + period * (stage.stride * stage.taps + 1)) % period;
    if domain.addressing == 1u {
        return vec2<u32>(m);
    }
    return vec2<u32>(min(m, period - 1 - m));
}

// Everything lies in one plane.
fn nearness(centre: vec4<f32>, other: vec4<f32>, sigma: f32) -> f32 {
    return 1.0;
}

// Sums begin with the first stage.
fn has_sum() -> bool {
    return stage.begun != 0u;
}
