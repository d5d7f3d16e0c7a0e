// A mesh, seen by the eye.

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) position_mm: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Exitance and visibility of lights, where they are known for every vertex.
    @location(3) exitance: vec3<f32>,
    @location(4) visibility: vec4<f32>,
}

@vertex
fn project(
    @location(0) position_mm: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) point: u32,
) -> Varying {
    let clip = scene.clip_from_world * vec4<f32>(position_mm, 1.0);
    return Varying(clip, position_mm, normal, uv, vertex_exitance(point), vertex_visibility(point));
}

// Depth along the line of sight, from the middle of the scene, in mm.
fn depth_of(position_mm: vec3<f32>) -> f32 {
    return dot(position_mm - scene.eye_mm, scene.forward) - scene.middle_mm;
}
