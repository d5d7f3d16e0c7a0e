// Where on the patch a point of a surface lies, in copies of the patch.

// Shares of the three sides of a box that a normal faces.
fn sides_of(normal: vec3<f32>) -> vec3<f32> {
    let n2 = normal * normal;
    let n8 = n2 * n2 * n2 * n2;
    return n8 / (n8.x + n8.y + n8.z);
}

// Coordinates on the sides that face x, y and z, each in its own size, upright where it can be.
fn on_side_x(p: vec3<f32>, n: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(-p.z * select(-1.0, 1.0, n.x >= 0.0), -p.y) * scene.patches_per_mm + 0.5;
}

fn on_side_y(p: vec3<f32>, n: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(p.x, p.z * select(-1.0, 1.0, n.y >= 0.0)) * scene.patches_per_mm + 0.5;
}

fn on_side_z(p: vec3<f32>, n: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(p.x * select(-1.0, 1.0, n.z >= 0.0), -p.y) * scene.patches_per_mm + 0.5;
}

// A number from 0 to 1 for every block of half a pixel of the material, the same wherever it is seen from (hash of three
// integers after Jarzynski and Olano 2020).
fn chance(position_mm: vec3<f32>) -> f32 {
    let cell = vec3<i32>(floor(position_mm / (0.5 * scene.pitch_mm)));
    var v = vec3<u32>(cell) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v = v ^ (v >> vec3<u32>(16u));
    v.x += v.y * v.z;
    return f32(v.x >> 8u) / 16777216.0;
}

// One place for what cannot be blended: where sides meet, pixels are of one or the other by chance.
fn place_of(p: vec3<f32>, n: vec3<f32>, uv: vec2<f32>) -> vec2<f32> {
    if scene.is_boxed == 0u {
        return uv;
    }
    let sides = sides_of(n);
    let dice = chance(p);
    if dice < sides.x {
        return on_side_x(p, n);
    }
    if dice < sides.x + sides.y {
        return on_side_y(p, n);
    }
    return on_side_z(p, n);
}
