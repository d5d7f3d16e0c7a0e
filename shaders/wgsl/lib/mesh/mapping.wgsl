// Places of the material at a point of a surface: by texture coordinates of the mesh, or on the sides of a box.

// Two sides of the box, 0 to 2 for those that face x, y and z, and the share of the first, 0.5 to 1.
struct BoxSides {
    first: u32,
    second: u32,
    share: f32,
}

// Texture coordinates of a point in copies of the patch, two that are blended: f = exp(P / 2), and all that is linear in it.
struct Places {
    first: vec2<f32>,
    second: vec2<f32>,
    sides: BoxSides,
}

// The two sides of the greatest shares; the least is taken off all, so that sides change where they have no share.
fn box_sides(shares: vec3<f32>) -> BoxSides {
    var each = abs(shares);
    var first = select(2u, 1u, each.y >= each.z);
    if each.x >= each.y && each.x >= each.z {
        first = 0u;
    }
    let next = (first + 1u) % 3u;
    let last = (first + 2u) % 3u;
    let in_order = each[next] >= each[last];
    let least = select(next, last, in_order);
    let a = each[first] - each[least];
    let b = each[select(last, next, in_order)] - each[least];
    return BoxSides(first, select(last, next, in_order), select(1.0, a / max(a + b, 1e-9), b > 0.0));
}

// The only place of a mesh with texture coordinates.
fn mesh_sides() -> BoxSides {
    return BoxSides(0u, 0u, 1.0);
}

// Components across a side of the box, of a direction.
fn across_side(side: u32, d: vec3<f32>) -> vec2<f32> {
    return select(select(d.xy, d.xz, side == 1u), d.zy, side == 0u);
}

// Texture coordinates of a position in mm on a side, true to size, upright where they can be.
fn on_side(side: u32, p: vec3<f32>, shares: vec3<f32>) -> vec2<f32> {
    let towards = select(vec3<f32>(-1.0), vec3<f32>(1.0), shares >= vec3<f32>(0.0));
    var place = vec2<f32>(p.x * towards.z, -p.y);
    if side == 0u {
        place = vec2<f32>(-p.z * towards.x, -p.y);
    } else if side == 1u {
        place = vec2<f32>(p.x, p.z * towards.y);
    }
    return place * object.patches_per_mm + 0.5;
}

// Places of a position in mm of the world: by the shares of the sides of the box, or by texture coordinates.
fn places_of(position_mm: vec3<f32>, shares: vec3<f32>, uv: vec2<f32>) -> Places {
    if object.is_boxed == 0u {
        return Places(uv, uv, mesh_sides());
    }
    // In the axes of the mesh, in mm of the world.
    let p = (object.place_from_world * vec4<f32>(position_mm, 1.0)).xyz;
    let sides = box_sides(shares);
    return Places(on_side(sides.first, p, shares), on_side(sides.second, p, shares), sides);
}

// Texture coordinates, 0 to 2: mirrored patches repeat after two, and half floats are finest there.
fn within_two(uv: vec2<f32>) -> vec2<f32> {
    return fract(uv * 0.5) * 2.0;
}
