// Vertex shader of meshes, as the camera sees them.

struct Varying {
    // Position in clip space; in the fragment shader, in pixels.
    @builtin(position) clip: vec4<f32>,
    @location(0) position_mm: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // Texture coordinates in copies of the patch, v down.
    @location(2) uv: vec2<f32>,
    // Exitance, and visibility of the first four lights and of the others, where they are known for every vertex.
    @location(3) exitance: vec3<f32>,
    @location(4) visibility: vec4<f32>,
    @location(7) visibility_of_last: vec4<f32>,
    // Ambient transfer: light from all around that comes from the same side and from the other, relative to that on a plane.
    @location(5) sky_front: vec3<f32>,
    @location(6) sky_back: vec3<f32>,
    // Signed shares of the sides of the box, for box mapping.
    @location(8) sides: vec3<f32>,
}

@vertex
fn project(
    @builtin(vertex_index) vertex: u32,
    @location(0) position_mm: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) point: u32,
    @location(4) sky_front: vec4<f32>,
    @location(5) sky_back: vec4<f32>,
    @location(7) sides: vec4<f32>,
) -> Varying {
    let position = world_position(position_mm);
    var out: Varying;
    out.clip = scene.clip_from_world * vec4<f32>(position, 1.0);
    out.position_mm = position;
    out.normal = world_direction(normal);
    out.uv = material_uv(uv);
    out.exitance = vertex_exitance(vertex, point, sides.xyz);
    let seen = vertex_visibilities(point);
    out.visibility = seen.first;
    out.visibility_of_last = seen.last;
    out.sky_front = 2.0 * sky_front.xyz;
    out.sky_back = 2.0 * sky_back.xyz;
    out.sides = sides.xyz;
    return out;
}

// Scattered light of the environment, divided by the albedo: it changes little within the radius of scattering.
fn scattered_sky(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    return in.sky_front * sky_irradiance(normal) + in.sky_back * sky_irradiance(-normal);
}

// Depth of a position along the axis of the camera, from the middle of the group, in mm.
fn depth_of(position_mm: vec3<f32>) -> f32 {
    return dot(position_mm - scene.centre_mm, scene.forward) + object.depth_offset_mm;
}
