// Vertex shader of meshes with tangents, as BTFs need them.

struct Varying {
    // Position in clip space; in the fragment shader, in pixels.
    @builtin(position) clip: vec4<f32>,
    @location(0) position_mm: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // Texture coordinates in copies of the material, v down.
    @location(2) uv: vec2<f32>,
    // Unit vector along the rows of the material; in the fourth place, 1 if normal x tangent goes down its columns, -1 if up.
    @location(3) tangent: vec4<f32>,
}

@vertex
fn project(
    @location(0) position_mm: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(6) tangent: vec4<f32>,
) -> Varying {
    let position = world_position(position_mm);
    let clip = scene.clip_from_world * vec4<f32>(position, 1.0);
    let along = vec4<f32>(world_direction(tangent.xyz), tangent.w * object.handedness);
    return Varying(clip, position, world_direction(normal), material_uv(uv), along);
}
