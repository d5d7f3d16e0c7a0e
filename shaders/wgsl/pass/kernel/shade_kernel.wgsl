// Needs: <target format>, tone, display, fresnel, object, scene, coat, host_shadow, tsm_visibility, visibilities, vertex_none, vertex, neighbours, upsampling, terms_1, sums, kernel_profile, shading.
// Picture of a mesh from light that a separable kernel has blurred on the screen, and the scattered light of the environment.

// Exitance; depth in mm in the fourth channel.
@group(1) @binding(1) var sums: TargetMaps;

// Exitance of a fragment; linear Rec. 709.
fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    let sum = sums_at(in.clip.xy, depth_of(in.position_mm))[0];
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
