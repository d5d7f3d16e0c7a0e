// Exitance from what was splatted, and the environment's.

// Exitance without the albedo, and depth in the fourth place.
@group(1) @binding(3) var collapsed: texture_2d<f32>;

fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    let change = step_of(in.position_mm, in.uv);
    let albedo = layer_at(0u, in.position_mm, normal, in.uv, change);
    let depth = depth_of(in.position_mm);
    let last = vec2<i32>(textureDimensions(collapsed)) - 1;
    let place = between(in.clip.xy);
    var sum = vec3<f32>(0.0);
    var weights = 0.0;
    for (var k = 0u; k < NEIGHBOURS; k++) {
        if k == 4u && weights > ENOUGH {
            break;
        }
        let value = textureLoad(collapsed, clamp(place.first + neighbour(k), vec2<i32>(0), last), 0);
        let weight = near_weight(linear_weight(k, place.part), (value.w - depth) / upsampling.near_mm);
        weights += weight;
        sum += weight * value.xyz;
    }
    return albedo * (sum / weights + scattered_sky(in, normal));
}

fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    return visibility(i, in.position_mm, normal);
}
