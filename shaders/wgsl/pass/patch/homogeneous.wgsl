// Needs: fullscreen.
// Blur of a flat patch by one kernel for all pixels, along one axis (Jimenez et al. 2015, eq. 10): the homogeneous baseline.

struct Kernel {
    // Weights at 0, 1, 2 ... pixels to either side; linear Rec. 709, of a sum over all taps of the root of the albedo.
    weights: array<vec4<f32>, 64>,
    // (1, 0) or (0, 1).
    axis: vec2<i32>,
    // Taps to each side, at most 63.
    taps: i32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> kernel: Kernel;
@group(0) @binding(1) var nearest: sampler;
@group(0) @binding(2) var image: texture_2d<f32>;

@fragment
fn homogeneous(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let size = vec2<f32>(textureDimensions(image));
    var sum = vec3<f32>(0.0);
    for (var k = -kernel.taps; k <= kernel.taps; k++) {
        let weight = kernel.weights[min(abs(k), 63)].xyz;
        // The sampler wraps beyond the border.
        sum += weight * textureSampleLevel(image, nearest, (at.xy + vec2<f32>(k * kernel.axis)) / size, 0.0).xyz;
    }
    return vec4<f32>(sum, 1.0);
}
