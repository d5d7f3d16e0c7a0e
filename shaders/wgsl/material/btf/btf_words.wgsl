// A BTF file as it is, in words, and where its nested codebooks stand in it.

// Rows of items of a few bits: an index, the code of a scale above it, and perhaps more.
struct BtfTable {
    // First bit in the file.
    start: u32,
    // Bits of an item and of a row.
    width: u32,
    row_bits: u32,
    // Bits of the index, and the largest that leads anywhere.
    index_bits: u32,
    last: u32,
    // Bits of a code that are not its sign, where the sign is, and 1 if there is one.
    code_mask: u32,
    sign_at: u32,
    sign_mask: u32,
    // Code c stands for 2^((offset + (c << step)) / 64).
    step: u32,
    offset: i32,
    pad_0: u32,
    pad_1: u32,
}

struct BtfBooks {
    // P6, P4, P3 and P2 of each stage.
    chains: array<BtfTable, 16>,
    // Index of P2 and, above it, one of I2.
    merged: BtfTable,
    // Indices of I1 and of C.
    i2: BtfTable,
    i1: BtfTable,
    // Of each stage, first bit of the lowest eight bits of the codes of P2, and of P1; 1 if values have signs.
    p2_bytes: vec4<u32>,
    p1: vec4<u32>,
    is_signed: vec4<u32>,
    // First bit of C and of the tints.
    colours: u32,
    tints: u32,
    // Number of tints, and where theirs is in items of P6 of the first stage.
    tint_count: u32,
    tint_at: u32,
    // Of the index of I2 in M: its bits, and the largest.
    i2_mask: u32,
    last_i2: u32,
    stages: u32,
    // 1 if chroma is divided by luma.
    is_relative: u32,
    // Chroma of code 0 and of a step of a code.
    first: vec2<f32>,
    step: vec2<f32>,
    // n_alpha, n_beta, n_theta, n_phi.
    nodes: vec4<u32>,
    alpha_max: f32,
    sin_beta_max: f32,
    theta_max: f32,
    cos_light_min: f32,
    // 1 display, 2 LogLuv.
    tone: u32,
    // Linear value of display white, or the toe of LogLuv.
    white: f32,
    // log2(1 + peak / toe).
    octaves: f32,
    // The last word of the file.
    last_word: u32,
}

@group(1) @binding(0) var<uniform> books: BtfBooks;
// Little-endian words, 2048 to a row.
@group(1) @binding(1) var words: texture_2d<u32>;

fn word(index: u32) -> u32 {
    let at = min(index, books.last_word);
    return textureLoad(words, vec2<u32>(at & 2047u, at >> 11u), 0).x;
}

fn byte_at(bit: u32) -> u32 {
    return (word(bit >> 5u) >> (bit & 24u)) & 255u;
}

// 32 bits of two words from a bit of the lower one on. There are no shifts by 32: by one, then by the rest.
fn joined(low: u32, high: u32, shift: u32) -> u32 {
    return (low >> shift) | ((high << 1u) << (31u - shift));
}

fn bits_at(bit: u32) -> u32 {
    let at = bit >> 5u;
    return joined(word(at), word(at + 1u), bit & 31u);
}

// The same, and the bits that follow `width` < 32 of them.
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

fn mask_of(width: u32) -> u32 {
    return (1u << (width & 31u)) - 1u;
}

// An index of the table's kind from the lowest bits.
fn index_of(table: BtfTable, bits: u32) -> u32 {
    return min(bits & mask_of(table.index_bits), table.last);
}

// First bit of an item.
fn item_at(table: BtfTable, row: u32, node: u32) -> u32 {
    return table.start + row * table.row_bits + node * table.width;
}
