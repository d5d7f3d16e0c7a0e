// Needs: <target format>, tone, display, fresnel, object, scene, coat, host_shadow, tsm_visibility, visibilities, vertex_none, vertex, neighbours, upsampling, kernel_profile, shading.
// Picture of a mesh from light that a separable kernel has blurred on the screen, and the scattered light of the environment.

// Exitance; depth in mm in the fourth channel.
@group(1) @binding(1) var sums: TargetTexture;

// Exitance at a pixel of the picture, from texels of about its depth in mm.
fn sum_at(pixel: vec2<f32>, depth: f32) -> vec3<f32> {
    let coord = bilinear_coord(pixel);
    var total = vec3<f32>(0.0);
    var weights = 0.0;
    for (var k = 0u; k < NEIGHBOURS; k++) {
        if k == 4u && weights > ENOUGH {
            break;
        }
        let texel = clamp(coord.first + neighbour(k), vec2<i32>(0), upsampling.last);
        let value = unpack(textureLoad(sums, texel, 0));
        let weight = near_weight(linear_weight(k, coord.part), (value.w - depth) / upsampling.near_mm);
        weights += weight;
        total += weight * value.xyz;
    }
    return total / weights;
}

// Exitance of a fragment; linear Rec. 709.
fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    let sum = sum_at(in.clip.xy, depth_of(in.position_mm));
    return max(sum + profile.reflectance.xyz * scattered_sky(in, normal), vec3<f32>(0.0));
}

// Visibility of light `i`, 0 to 1.
fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    return visibility(i, in.position_mm, normal);
}

@fragment
fn shade_kernel(in: Varying) -> @location(0) vec4<f32> {
    return shaded(in);
}
