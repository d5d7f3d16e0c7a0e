// Object: where a mesh is in the world, and how its material lies on it.

struct Object {
    // From mm of the mesh to mm of the world: a rotation, a uniform scale, a translation.
    world_from_mesh: mat4x4<f32>,
    // From the world to the axes of the mesh, without the scale: where box mapping looks up the material.
    place_from_world: mat4x4<f32>,
    // Copies of the material to the unit square of texture coordinates.
    uv_scale: vec2<f32>,
    // Box mapping: copies of the patch to a mm, in x and y.
    patches_per_mm: vec2<f32>,
    // 0 texture coordinates, 1 box mapping.
    is_boxed: u32,
    // Refractive index of the material against air.
    eta: f32,
    // 1 - F_dr from outside: share of light from all around that enters.
    sky_transmittance: f32,
    // GGX roughness of the coat, 0 to 1.
    roughness: f32,
    // Added to depth from the middle of the scene, in mm: depth 0 is in the middle of the group.
    depth_offset_mm: f32,
    // Number of the group that exchanges light with the object, from 1 on.
    group: f32,
    // 1, or -1 where the transform is a mirror.
    handedness: f32,
    pad: u32,
}

@group(2) @binding(0) var<uniform> object: Object;

// Position in mm of the world.
fn world_position(position_mm: vec3<f32>) -> vec3<f32> {
    return (object.world_from_mesh * vec4<f32>(position_mm, 1.0)).xyz;
}

// Normal or tangent of the mesh in the world, as long as the scale.
fn world_direction(direction: vec3<f32>) -> vec3<f32> {
    return (object.world_from_mesh * vec4<f32>(direction, 0.0)).xyz;
}

// Texture coordinates in copies of the material, v down.
fn material_uv(uv: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(uv.x * object.uv_scale.x, 1.0 - uv.y * object.uv_scale.y);
}

// Whether what a translucent shadow map shows belongs to the group of this object, by the fourth channel of its flux.
fn is_of_group(stored: f32) -> bool {
    return abs(stored - object.group) < 0.5;
}

// Share of the irradiance of a light that enters the surface, 0 to 1: F_t(cos) max(cos, 0).
fn entering(normal: vec3<f32>, towards: vec3<f32>) -> f32 {
    let cosine = clamp(dot(normal, towards), 0.0, 1.0);
    return fresnel_transmittance(cosine, object.eta) * cosine;
}

// Irradiance of the environment that enters a surface of unit normal n (Ramamoorthi and Hanrahan 2001, eq. 13).
fn sky_irradiance(n: vec3<f32>) -> vec3<f32> {
    let linear = scene.sky[0].xyz + scene.sky[1].xyz * n.y + scene.sky[2].xyz * n.z + scene.sky[3].xyz * n.x;
    let mixed = scene.sky[4].xyz * n.x * n.y + scene.sky[5].xyz * n.y * n.z + scene.sky[7].xyz * n.x * n.z;
    let square = scene.sky[6].xyz * (3.0 * n.z * n.z - 1.0) + scene.sky[8].xyz * (n.x * n.x - n.y * n.y);
    return max(linear + mixed + square, vec3<f32>(0.0)) * object.sky_transmittance;
}
