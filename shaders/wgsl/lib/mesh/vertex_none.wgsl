// Zeros for exitance and visibility, where they are not known for every vertex.

fn vertex_exitance(vertex: u32, point: u32, shares: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(0.0);
}

fn vertex_visibilities(point: u32) -> Visibilities {
    return Visibilities(vec4<f32>(0.0), vec4<f32>(0.0));
}
