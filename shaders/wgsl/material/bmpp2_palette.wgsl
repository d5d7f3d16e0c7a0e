// Storage of 2-BMPP with a palette of pairs of base materials, in 16 bits per pixel.

// Number of the pair in the lower 11 bits, 31 t in the upper 5.
@group(0) @binding(2) var codes: texture_2d<u32>;
// Base-material indices of the pairs, one pair to a texel of the only row.
@group(0) @binding(3) var pairs: texture_2d<u32>;

// The pixel at a texel of the patch.
fn load_pixel(texel: vec2<u32>) -> Pixel {
    let code = textureLoad(codes, texel, 0).x;
    let pair = min(code % 2048u, textureDimensions(pairs).x - 1u);
    let base = textureLoad(pairs, vec2<u32>(pair, 0u), 0).xy;
    return Pixel(base_texel(base.x), base_texel(base.y), f32(code / 2048u) / 31.0);
}
