// One separable kernel for the whole patch, along one axis (Jimenez et al. 2015, eq. 10): what heterogeneity is compared
// with.

struct Stage {
    // Weights of the taps at 0, 1, 2 ... pixels to either side; rgb, of sum 1 over all taps but for the albedo.
    kernel: array<vec4<f32>, 64>,
    // (1, 0) or (0, 1).
    axis: vec2<i32>,
    // Taps to each side.
    taps: i32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> stage: Stage;
@group(0) @binding(1) var nearest: sampler;
@group(0) @binding(2) var image: texture_2d<f32>;

@fragment
fn homogeneous(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let size = vec2<f32>(textureDimensions(image));
    var sum = vec3<f32>(0.0);
    for (var k = -stage.taps; k <= stage.taps; k++) {
        let weight = stage.kernel[min(abs(k), 63)].xyz;
        // Beyond the border the sampler wraps.
        sum += weight * textureSampleLevel(image, nearest, (at.xy + vec2<f32>(k * stage.axis)) / size, 0.0).xyz;
    }
    return vec4<f32>(sum, 1.0);
}
