// Needs: <target format>, tone, display, fresnel, object, scene, coat, mapping, tsm_visibility, patch_layers, vertex_none, vertex, neighbours, upsampling, shading.
// Picture of a mesh from the resolved splats, and the scattered light of the environment.

// Exitance divided by the albedo; depth in mm in the fourth channel.
@group(1) @binding(3) var resolved: texture_2d<f32>;

// Exitance of a fragment; linear Rec. 709.
fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    let slopes = derivatives(in.position_mm, in.uv);
    let albedo = layer_at(0u, in.position_mm, normal, in.uv, slopes);
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
    return albedo * (sum / weights + scattered_sky(in, normal));
}

// Visibility of light `i`, 0 to 1.
fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    return visibility(i, in.position_mm, normal);
}

@fragment
fn shade_splat(in: Varying) -> @location(0) vec4<f32> {
    return shaded(in);
}
