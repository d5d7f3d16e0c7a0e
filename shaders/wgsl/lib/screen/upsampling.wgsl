// Position of a pixel of the picture in maps that are coarser than it, or lie over a part of it.

struct Upsampling {
    // Texels of the maps to a pixel of the picture.
    texels_per_pixel: vec2<f32>,
    // Pixel of the target where the first texel of the maps lies.
    origin: vec2<f32>,
    // Difference of depth in mm by which the weight of a texel falls to a half.
    near_mm: f32,
    pad_0: u32,
    // Last column and row of the maps that hold anything.
    last: vec2<i32>,
}

@group(1) @binding(2) var<uniform> upsampling: Upsampling;

// The first of the four texels around a pixel, and the weight of the next ones, 0 to 1.
struct BilinearCoord {
    first: vec2<i32>,
    part: vec2<f32>,
}

// Of a pixel of the picture.
fn bilinear_coord(pixel: vec2<f32>) -> BilinearCoord {
    let corner = (pixel - upsampling.origin) * upsampling.texels_per_pixel - 0.5;
    return BilinearCoord(vec2<i32>(floor(corner)), corner - floor(corner));
}
