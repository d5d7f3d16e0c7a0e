// Texture coordinates of a point of a surface, in copies of the patch: of the mesh, or by box mapping.

// Shares of the three sides of a box that a normal faces.
fn sides_of(normal: vec3<f32>) -> vec3<f32> {
    let n2 = normal * normal;
    let n8 = n2 * n2 * n2 * n2;
    return n8 / (n8.x + n8.y + n8.z);
}

// Texture coordinates on the sides of the box that face x, y and z, true to size, upright where they can be.
fn on_side_x(p: vec3<f32>, n: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(-p.z * select(-1.0, 1.0, n.x >= 0.0), -p.y) * object.patches_per_mm + 0.5;
}

fn on_side_y(p: vec3<f32>, n: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(p.x, p.z * select(-1.0, 1.0, n.y >= 0.0)) * object.patches_per_mm + 0.5;
}

fn on_side_z(p: vec3<f32>, n: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(p.x * select(-1.0, 1.0, n.z >= 0.0), -p.y) * object.patches_per_mm + 0.5;
}

// A number from 0 to 1 for every block of half a pixel of the material, the same wherever it is seen from (hash of three
// integers after Jarzynski and Olano 2020).
fn random_of_block(position_mm: vec3<f32>) -> f32 {
    let cell = vec3<i32>(floor(position_mm / (0.5 * object.pitch_mm)));
    var v = vec3<u32>(cell) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v = v ^ (v >> vec3<u32>(16u));
    v.x += v.y * v.z;
    return f32(v.x >> 8u) / 16777216.0;
}

// Position in the axes of the mesh, in mm of the world.
fn place_of(position_mm: vec3<f32>) -> vec3<f32> {
    return (object.place_from_world * vec4<f32>(position_mm, 1.0)).xyz;
}

// Direction of the world in the axes of the mesh.
fn place_direction(direction: vec3<f32>) -> vec3<f32> {
    return (object.place_from_world * vec4<f32>(direction, 0.0)).xyz;
}

// Texture coordinates of a point in mm of the world, of a unit normal. Indices cannot be blended: where two sides of the box meet, pixels are
// of one or the other by chance.
fn patch_uv(position_mm: vec3<f32>, normal: vec3<f32>, uv: vec2<f32>) -> vec2<f32> {
    if object.is_boxed == 0u {
        return uv;
    }
    let p = place_of(position_mm);
    let n = place_direction(normal);
    let sides = sides_of(n);
    let dice = random_of_block(p);
    if dice < sides.x {
        return on_side_x(p, n);
    }
    if dice < sides.x + sides.y {
        return on_side_y(p, n);
    }
    return on_side_z(p, n);
}
