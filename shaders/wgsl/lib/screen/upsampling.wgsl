// Maps that are coarser than the picture: linear between their texels, those at other depths left out.

struct Upsampling {
    // Texels of the maps to a pixel of the picture.
    texels_per_pixel: vec2<f32>,
    // Differences of depth count in this, in mm.
    near_mm: f32,
    pad: u32,
}

@group(1) @binding(2) var<uniform> upsampling: Upsampling;

// The texel of maps of a size that a pixel lies next to, or between it and the next ones, and how far.
struct Between {
    first: vec2<i32>,
    part: vec2<f32>,
}

fn between(pixel: vec2<f32>) -> Between {
    let corner = pixel * upsampling.texels_per_pixel - 0.5;
    return Between(vec2<i32>(floor(corner)), corner - floor(corner));
}
