// Blur of all irradiance maps by one stage of the cascade of Gaussians, along one axis.

struct BlurStage {
    // w_lma of this stage's a, shape [l][m]; linear Rec. 709.
    weights: array<vec4<f32>, 4>,
    // (1, 0) or (0, 1); in a volume also (0, 0), across slices.
    axis: vec2<i32>,
    // On a flat patch: standard deviation and distance of taps in pixels; taps to each side. In a volume, in cells.
    sigma: f32,
    stride: i32,
    taps: i32,
    // On the screen: standard deviation of this stage, and distance of taps that the blur so far allows, in pixels of the
    // material. In a volume `step` is the sum of the weights of all taps.
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
