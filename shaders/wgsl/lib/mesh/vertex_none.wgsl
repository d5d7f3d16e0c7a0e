// Zeros for exitance and visibility, where they are not known for every vertex.

fn vertex_exitance(point: u32) -> vec3<f32> {
    return vec3<f32>(0.0);
}

fn vertex_visibility(point: u32) -> vec4<f32> {
    return vec4<f32>(0.0);
}
