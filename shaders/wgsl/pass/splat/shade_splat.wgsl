// Needs: <target format>, tone, display, fresnel, object, scene, coat, mapping, host_shadow, tsm_visibility, patch_layers, visibilities, vertex_none, vertex, neighbours, upsampling, shading.
// Picture of a mesh from the resolved splats, and the scattered light of the environment.

// Exitance divided by the albedo; depth in mm in the fourth channel.
@group(1) @binding(3) var resolved: texture_2d<f32>;

// Light that enters from sources which have no translucent shadow map, and so no samples: it leaves where it enters, as on flat,
// open ground.
fn unspread_light(position_mm: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < scene.lights; i++) {
        if scene.light[min(i, MAX_LIGHTS - 1u)].shadow != OWN_SHADOW {
            let from_light = incident(i, position_mm);
            let share = entering(normal, from_light.towards);
            if share > 0.0 {
                sum += from_light.irradiance * share * visibility(i, position_mm, normal);
            }
        }
    }
    return sum;
}

// Exitance of a fragment; linear Rec. 709.
fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    let albedo = layer_at(0u, lookup_of(in));
    let depth = depth_of(in.position_mm);
    let coord = bilinear_coord(in.clip.xy);
    var sum = vec3<f32>(0.0);
    var weights = 0.0;
    for (var k = 0u; k < NEIGHBOURS; k++) {
        if k == 4u && weights > ENOUGH {
            break;
        }
        let value = textureLoad(resolved, clamp(coord.first + neighbour(k), vec2<i32>(0), upsampling.last), 0);
        let weight = near_weight(linear_weight(k, coord.part), (value.w - depth) / upsampling.near_mm);
        weights += weight;
        sum += weight * value.xyz;
    }
    return albedo * (sum / weights + unspread_light(in.position_mm, normal) + scattered_sky(in, normal));
}

// Visibility of light `i`, 0 to 1.
fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    return visibility(i, in.position_mm, normal);
}

@fragment
fn shade_splat(in: Varying) -> @location(0) vec4<f32> {
    return shaded(in);
}
