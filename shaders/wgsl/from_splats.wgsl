// Exitance from what was splatted, and the environment's.

// Exitance without the albedo, and depth in the fourth place.
@group(1) @binding(3) var collapsed: texture_2d<f32>;

fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    let change = step_of(in.position_mm, in.uv);
    let albedo = layer_at(0u, in.position_mm, normal, in.uv, change);
    let depth = depth_of(in.position_mm);
    var blend = blend_at(in.clip.xy, textureDimensions(collapsed));
    var sum = vec3<f32>(0.0);
    var weights = 0.0;
    for (var k = 0u; k < 4u; k++) {
        let value = textureLoad(collapsed, blend.texel[k], 0);
        let weight = near_weight(blend.weight[k], value.w - depth);
        weights += weight;
        sum += weight * value.xyz;
    }
    return albedo * (sum / weights + scattered_sky(in, normal));
}

fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    return visibility(i, in.position_mm, normal);
}
