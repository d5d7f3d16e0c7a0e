// Plain arrays in textures.

// Texels to a row of them. A power of two that the compiler knows: it needs no division, which some processors do number by number.
const ROW: u32 = 2048u;

// Texel of entry `index`.
fn array_texel(index: u32) -> vec2<u32> {
    return vec2<u32>(index % ROW, index / ROW);
}
