// File of a BTF of nested codebooks as it is, in 32-bit words, and where its codebooks stand in it.

// Table of packed items: an index, the code of a scale above it, and perhaps more.
struct BtfTable {
    // First bit in the file.
    start: u32,
    // Number of bits of an item and of a row.
    width: u32,
    row_bits: u32,
    // Number of bits of the index, and the largest valid index.
    index_bits: u32,
    last: u32,
    // Mask of a code without its sign, bit of the sign, and 1 if there is one.
    code_mask: u32,
    sign_at: u32,
    sign_mask: u32,
    // Scale of code c: 2^((offset + (c << step)) / 64).
    step: u32,
    offset: i32,
    pad_0: u32,
    pad_1: u32,
}

// Codebooks of a file, named as in its format.
struct BtfCodebooks {
    // Tables P6, P4, P3 and P2 of each stage, shape [stage][4].
    chains: array<BtfTable, 16>,
    // Table M: index of P2 and, above it, one of I2.
    merged: BtfTable,
    // Tables I2 and I1: indices of I1 and of C.
    i2: BtfTable,
    i1: BtfTable,
    // For each stage: first bit of the low bytes of the codes of P2, first bit of P1, 1 if values of P1 have signs.
    p2_bytes: vec4<u32>,
    p1: vec4<u32>,
    is_signed: vec4<u32>,
    // First bits of C and of the tints.
    colours: u32,
    tints: u32,
    // Number of tints, and first bit of the number of a tint in items of P6 of the first stage.
    tint_count: u32,
    tint_at: u32,
    // Mask of the index of I2 in M, and the largest valid one.
    i2_mask: u32,
    last_i2: u32,
    // Additive stages, 1 to 4.
    stages: u32,
    // 1 if chroma is divided by luma.
    is_relative: u32,
    // Chroma of code 0, and of a step of a code.
    first: vec2<f32>,
    step: vec2<f32>,
    // Nodes of the grid: n_alpha, n_beta, n_theta, n_phi.
    nodes: vec4<u32>,
    // Largest alpha in rad, sin beta and theta in rad of the grid; cosine of the lowest measured light.
    alpha_max: f32,
    sin_beta_max: f32,
    theta_max: f32,
    cos_light_min: f32,
    // 1 display values, 2 LogLuv.
    colour_encoding: u32,
    // Radiance value of display white, linear, or the toe of LogLuv.
    white: f32,
    // log2(1 + peak / toe) of LogLuv.
    octaves: f32,
    // Number of the last word of the file.
    last_word: u32,
}

@group(1) @binding(0) var<uniform> codebooks: BtfCodebooks;
// Words of the file, little-endian, 2048 to a row.
@group(1) @binding(1) var words: texture_2d<u32>;

// Word of the file, clamped to the last.
fn word(index: u32) -> u32 {
    let at = min(index, codebooks.last_word);
    return textureLoad(words, vec2<u32>(at & 2047u, at >> 11u), 0).x;
}

// Byte that begins at a bit, a multiple of 8.
fn byte_at(bit: u32) -> u32 {
    return (word(bit >> 5u) >> (bit & 24u)) & 255u;
}

// 32 bits of two words from bit `shift` of the lower one on. WGSL has no shifts by 32: by one, then by the rest.
fn joined(low: u32, high: u32, shift: u32) -> u32 {
    return (low >> shift) | ((high << 1u) << (31u - shift));
}

// 32 bits of the file from a bit on.
fn bits_at(bit: u32) -> u32 {
    let at = bit >> 5u;
    return joined(word(at), word(at + 1u), bit & 31u);
}

// 32 bits from a bit on, and 32 bits from `width` < 32 bits later on.
fn two_at(bit: u32, width: u32) -> vec2<u32> {
    let at = bit >> 5u;
    let loaded = vec3<u32>(word(at), word(at + 1u), word(at + 2u));
    let shift = bit & 31u;
    let first = joined(loaded.x, loaded.y, shift);
    let later = shift + width;
    if later < 32u {
        return vec2<u32>(first, joined(loaded.x, loaded.y, later));
    }
    return vec2<u32>(first, joined(loaded.y, loaded.z, later & 31u));
}

// Mask of the lowest `width` < 32 bits.
fn mask_of(width: u32) -> u32 {
    return (1u << (width & 31u)) - 1u;
}

// Index of an item of a table, clamped to the largest valid one.
fn index_of(table: BtfTable, bits: u32) -> u32 {
    return min(bits & mask_of(table.index_bits), table.last);
}

// First bit of the item of a row at a node.
fn item_at(table: BtfTable, row: u32, node: u32) -> u32 {
    return table.start + row * table.row_bits + node * table.width;
}
