// Needs: <target format>, tone, display, fresnel, object, scene, coat, mapping, visibilities, array, exitance_vertex, vertex, shading.
// Picture of a mesh from the exitance of its vertices.

// Exitance, linear between the vertices.
fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    return in.exitance;
}

// Visibility of light `i`, 0 to 1, linear between the vertices.
fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    return visibility_of(i, Visibilities(in.visibility, in.visibility_of_last));
}

@fragment
fn shade_vertex(in: Varying) -> @location(0) vec4<f32> {
    return shaded(in);
}
