// Depth-aware bilinear filter: the four texels next to a place between texels, and the twelve around those.

const NEIGHBOURS: u32 = 16u;
// Weight of the four together with which the others are not looked at.
const ENOUGH: f32 = 0.01;
// Weight of each of the twelve, should none of the four be near in depth.
const OUTER: f32 = 0.02;

// Offset of texel k from the first of the four.
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

// Bilinear weight of texel k; `part` is where the place lies between the four, 0 to 1.
fn linear_weight(k: u32, part: vec2<f32>) -> f32 {
    if k >= 4u {
        return OUTER;
    }
    let each = mix(1.0 - part, part, vec2<f32>(neighbour(k)));
    return each.x * each.y;
}

// Weight, lowered for a texel whose depth differs by `apart` times what counts as near; never 0, for one has to count.
fn near_weight(weight: f32, apart: f32) -> f32 {
    return weight / (1.0 + apart * apart) + 1e-5 / (1.0 + abs(apart));
}
