// Texels around a place between texels: the four next to it, and the twelve around those.

const NEIGHBOURS: u32 = 16u;
// The four next to it are enough if they have this much weight together.
const ENOUGH: f32 = 0.01;
// Weight of those around them, should none of the four be near in depth.
const OUTER: f32 = 0.02;

fn neighbour(k: u32) -> vec2<i32> {
    if k < 4u {
        return vec2<i32>(i32(k & 1u), i32(k >> 1u));
    }
    // The rows above and below, then the columns beside.
    let j = i32(k) - 4;
    if j < 8 {
        return vec2<i32>(j % 4 - 1, select(-1, 2, j >= 4));
    }
    return vec2<i32>(select(-1, 2, j >= 10), (j - 8) % 2);
}

// Linear between the four; `part` is where the place lies between them.
fn linear_weight(k: u32, part: vec2<f32>) -> f32 {
    if k >= 4u {
        return OUTER;
    }
    let each = mix(1.0 - part, part, vec2<f32>(neighbour(k)));
    return each.x * each.y;
}

// Less for texels that are `apart` times what counts as near away in depth; never nothing, for one has to count.
fn near_weight(weight: f32, apart: f32) -> f32 {
    return weight / (1.0 + apart * apart) + 1e-5 / (1.0 + abs(apart));
}
