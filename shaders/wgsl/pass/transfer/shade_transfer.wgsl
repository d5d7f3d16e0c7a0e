// Needs: <target format>, tone, display, fresnel, object, scene, coat, host_shadow, tsm_visibility, visibilities, array, transfer_vertex, vertex, shading.
// Picture of a mesh from what is precomputed for its vertices.

// Exitance, linear between the vertices.
fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    return in.exitance;
}

// Visibility of light `i`, 0 to 1.
fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    return visibility(i, in.position_mm, normal);
}

@fragment
fn shade_transfer(in: Varying) -> @location(0) vec4<f32> {
    return shaded(in);
}
