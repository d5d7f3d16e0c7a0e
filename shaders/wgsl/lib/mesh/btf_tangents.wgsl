// Tangent frame of a textured mesh.

// Unit vectors in world space.
struct Tangents {
    // Along the rows of the material.
    x: vec3<f32>,
    // Down its columns.
    y: vec3<f32>,
    // The normal, on the side that the eye sees.
    z: vec3<f32>,
}

// Frame at a fragment, for the side that is seen, whichever way the triangle winds: `plane` is any normal of the triangle.
fn tangents_of(in: Varying, plane: vec3<f32>, to_eye: vec3<f32>) -> Tangents {
    let normal = normalize(in.normal);
    let x = normalize(in.tangent.xyz - normal * dot(in.tangent.xyz, normal));
    let y = cross(normal, x) * select(-1.0, 1.0, in.tangent.w >= 0.0);
    let side = dot(normal, plane) * dot(plane, to_eye);
    return Tangents(x, y, normal * select(-1.0, 1.0, side >= 0.0));
}

// A world-space direction in the frame of the material.
fn into_material(tangents: Tangents, direction: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(direction, tangents.x), dot(direction, tangents.y), dot(direction, tangents.z));
}
