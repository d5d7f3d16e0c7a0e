// Exitance from what was splatted, and the environment's.

struct Upsampling {
    // Texels of the maps to a pixel of the picture.
    texels_per_pixel: vec2<f32>,
    // Differences of depth count in this, in mm.
    near_mm: f32,
    pad: u32,
}

@group(1) @binding(2) var<uniform> upsampling: Upsampling;
// Exitance without the albedo, and depth in the fourth place.
@group(1) @binding(3) var collapsed: texture_2d<f32>;

fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    let change = step_of(in.position_mm, in.uv);
    let albedo = layer_at(0u, in.position_mm, normal, in.uv, change);
    let depth = depth_of(in.position_mm);
    let size = vec2<i32>(textureDimensions(collapsed));
    let corner = in.clip.xy * upsampling.texels_per_pixel - 0.5;
    let first = vec2<i32>(floor(corner));
    let part = corner - floor(corner);
    var sum = vec3<f32>(0.0);
    var weights = 0.0;
    for (var k = 0u; k < 4u; k++) {
        let step = vec2<i32>(i32(k & 1u), i32(k >> 1u));
        let value = textureLoad(collapsed, clamp(first + step, vec2<i32>(0), size - 1), 0);
        let apart = (value.w - depth) / upsampling.near_mm;
        let linear = mix(1.0 - part, part, vec2<f32>(step));
        let weight = linear.x * linear.y / (1.0 + apart * apart) + 1e-5 / (1.0 + abs(apart));
        weights += weight;
        sum += weight * value.xyz;
    }
    return albedo * (sum / weights + scattered_sky(in, normal));
}

fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    return visibility(i, in.position_mm, normal);
}
