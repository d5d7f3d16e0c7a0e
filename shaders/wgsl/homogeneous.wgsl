// One separable kernel for the whole patch, along one axis (Jimenez et al. 2015, eq. 10): what heterogeneity is compared
// with.

struct Stage {
    // Weights of the taps at 0, 1, 2 ... pixels to either side; rgb, of sum 1 over all taps but for the albedo.
    kernel: array<vec4<f32>, 64>,
    // (1, 0) or (0, 1).
    axis: vec2<i32>,
    // Pixels from one tap to the next, and taps to each side.
    stride: i32,
    taps: i32,
    sigma: f32,
    begun: u32,
    pad_0: u32,
    pad_1: u32,
}

// Stride, count and what `blur.wgsl` has for a width.
struct Taps {
    stride: i32,
    count: i32,
    sigma: f32,
}

@group(0) @binding(0) var<uniform> stage: Stage;
@group(0) @binding(2) var image: texture_2d<f32>;

@fragment
fn homogeneous(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let x = vec2<i32>(at.xy);
    var sum = vec3<f32>(0.0);
    for (var k = -stage.taps; k <= stage.taps; k++) {
        let weight = stage.kernel[min(abs(k), 63)].xyz;
        sum += weight * textureLoad(image, texel_at(x + k * stage.axis), 0).xyz;
    }
    return vec4<f32>(sum, 1.0);
}
