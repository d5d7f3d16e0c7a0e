// Domain of blurs on a flat patch: taps as far apart as the stage has them, wrapped at the border by the sampler.

@group(0) @binding(1) var nearest: sampler;

// Taps of the stage, the same for all texels.
fn taps_at(centre: vec4<f32>) -> Taps {
    // Depth is 0 here. Where nothing but uniforms says when a loop ends, Mesa's software Vulkan compiles it anew at every
    // draw.
    return Taps(stage.stride, stage.taps + i32(centre.w), stage.sigma);
}

// Everything lies in one plane: full weight.
fn nearness(centre: vec4<f32>, other: vec4<f32>) -> f32 {
    return 1.0;
}

// Whether there is a sum to add to: not at the first stage.
fn has_sum() -> bool {
    return stage.has_sum != 0u;
}

// Texture coordinates of the middle of a texel.
fn middle_of(x: vec2<i32>, size: vec2<u32>) -> vec2<f32> {
    return (vec2<f32>(x) + 0.5) / vec2<f32>(size);
}
