// Convolution with a Gaussian of sum 1 along one axis.

struct Blur {
    // Pixels of the patch.
    size: vec2<u32>,
    // (1, 0) or (0, 1).
    axis: vec2<i32>,
    // Standard deviation in pixels.
    sigma: f32,
    // Pixels to both sides.
    reach: i32,
    // 0 clamp, 1 repeat, 2 mirror.
    addressing: u32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> settings: Blur;
@group(0) @binding(1) var image: texture_2d<f32>;

// The pixel that a coordinate names. Steps beyond the border may be longer than the patch.
fn wrapped(x: vec2<i32>) -> vec2<u32> {
    let size = vec2<i32>(settings.size);
    if settings.addressing == 0u {
        return vec2<u32>(clamp(x, vec2<i32>(0), size - 1));
    }
    let period = size * select(1, 2, settings.addressing == 2u);
    // Made positive first: GLSL's remainder of negative numbers is another one.
    let m = (x + period * (settings.reach + 1)) % period;
    if settings.addressing == 1u {
        return vec2<u32>(m);
    }
    return vec2<u32>(min(m, period - 1 - m));
}

@fragment
fn blur(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let x = vec2<i32>(at.xy);
    var sum = vec3<f32>(0.0);
    var weights = 0.0;
    for (var k = -settings.reach; k <= settings.reach; k++) {
        let distance = f32(k) / settings.sigma;
        let weight = exp(-0.5 * distance * distance);
        sum += weight * textureLoad(image, wrapped(x + k * settings.axis), 0).xyz;
        weights += weight;
    }
    return vec4<f32>(sum / weights, 1.0);
}
