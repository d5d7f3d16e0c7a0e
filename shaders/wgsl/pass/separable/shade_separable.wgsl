// Exitance from blurred maps on the screen: M = sum over m of c_m S_m, and the environment's.

// S_m, and depth in the fourth place.
@group(1) @binding(3) var sums: KeptLayers;

// S_m at a pixel.
fn sums_at(pixel: vec2<f32>, depth: f32) -> array<vec3<f32>, TERMS> {
    let last = vec2<i32>(textureDimensions(sums)) - 1;
    let place = between(pixel);
    var total: array<vec3<f32>, TERMS>;
    var weights = 0.0;
    for (var k = 0u; k < NEIGHBOURS; k++) {
        if k == 4u && weights > ENOUGH {
            break;
        }
        let texel = clamp(place.first + neighbour(k), vec2<i32>(0), last);
        let value = told(textureLoad(sums, texel, 0u, 0));
        let weight = near_weight(linear_weight(k, place.part), (value.w - depth) / upsampling.near_mm);
        weights += weight;
        total[0] += weight * value.xyz;
        for (var m = 1u; m < TERMS; m++) {
            total[m] += weight * told(textureLoad(sums, texel, m, 0)).xyz;
        }
    }
    for (var m = 0u; m < TERMS; m++) {
        total[m] /= weights;
    }
    return total;
}

fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    let change = step_of(in.position_mm, in.uv);
    var c = factors_at(in.position_mm, normal, in.uv, change);
    var light = sums_at(in.clip.xy, depth_of(in.position_mm));
    var sum = c[TERMS] * scattered_sky(in, normal);
    for (var m = 0u; m < TERMS; m++) {
        sum += c[m] * light[m];
    }
    return max(sum, vec3<f32>(0.0));
}

fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    return visibility(i, in.position_mm, normal);
}
