// Storage of 2-BMPP with an index for each of the two base materials of a pixel.

// Mixture ratios t of the first base material, 0 to 1.
@group(0) @binding(2) var ratios: texture_2d<f32>;
// Base-material indices.
@group(0) @binding(3) var indices: texture_2d<u32>;

// The pixel at a texel of the patch.
fn load_pixel(texel: vec2<u32>) -> Pixel {
    let base = textureLoad(indices, texel, 0).xy;
    let t = textureLoad(ratios, texel, 0).x;
    return Pixel(base_texel(base.x), base_texel(base.y), t);
}
