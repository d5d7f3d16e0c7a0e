// Header of a material of any model: addressing of its pixels, nodes of its profiles.

struct Material {
    // Pixels of the patch, columns and rows.
    size: vec2<u32>,
    // 0 clamp, 1 repeat, 2 mirror.
    addressing: u32,
    // R, half the side of the window of neighbours, in pixels.
    window_radius: u32,
    // S, the number of nodes of a profile.
    samples: u32,
    // M, the number of base materials; 0 for per-pixel profiles.
    base_materials: u32,
    // Distance of neighbouring pixels.
    pitch_mm: f32,
    // Radius of the last node.
    r_max_mm: f32,
    // (S - 1) / r_max, in nodes per mm.
    nodes_per_mm: f32,
    // Rows to a layer of a plain array that has layers.
    rows: u32,
    pad_0: u32,
    // Blocks of OpenGL ES are multiples of 16 bytes.
    pad_1: u32,
}

@group(0) @binding(0) var<uniform> material: Material;

// Node h below a distance, and weight w of node h + 1, 0 to 1 (Yatagawa et al. 2020, eq. 3).
struct Knot {
    h: u32,
    w: f32,
}

// Knot of a distance of at most r_max.
fn knot_at(r_mm: f32) -> Knot {
    let position = r_mm * material.nodes_per_mm;
    let h = min(u32(position), material.samples - 2u);
    return Knot(h, position - f32(h));
}

// Pixel of the patch for coordinates within a window of it, by the addressing mode.
fn address(x: vec2<i32>) -> vec2<u32> {
    if material.addressing == 0u {
        return vec2<u32>(clamp(x, vec2<i32>(0), vec2<i32>(material.size) - 1));
    }
    // Mirrored patches repeat after two. Made positive first: GLSL's remainder of negative numbers is another one.
    let period = material.size * select(1u, 2u, material.addressing == 2u);
    let m = vec2<u32>(x + vec2<i32>(period * material.window_radius)) % period;
    if material.addressing == 1u {
        return m;
    }
    return min(m, period - 1u - m);
}
