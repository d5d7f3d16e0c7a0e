// Maps that are coarser than the picture: linear between their texels, those at other depths left out.

struct Upsampling {
    // Texels of the maps to a pixel of the picture.
    texels_per_pixel: vec2<f32>,
    // Differences of depth count in this, in mm.
    near_mm: f32,
    pad: u32,
}

@group(1) @binding(2) var<uniform> upsampling: Upsampling;

// Four texels, and how much of each.
struct Blend {
    texel: array<vec2<i32>, 4>,
    weight: array<f32, 4>,
}

// Where a pixel lies between texels of maps of a size.
fn blend_at(pixel: vec2<f32>, size: vec2<u32>) -> Blend {
    let corner = pixel * upsampling.texels_per_pixel - 0.5;
    let first = vec2<i32>(floor(corner));
    let part = corner - floor(corner);
    var blend: Blend;
    for (var k = 0u; k < 4u; k++) {
        let step = vec2<i32>(i32(k & 1u), i32(k >> 1u));
        let linear = mix(1.0 - part, part, vec2<f32>(step));
        blend.texel[k] = clamp(first + step, vec2<i32>(0), vec2<i32>(size) - 1);
        blend.weight[k] = linear.x * linear.y;
    }
    return blend;
}

// The weight of a texel whose depth is `apart` mm from the pixel's; never nothing, for one has to count.
fn near_weight(weight: f32, apart_mm: f32) -> f32 {
    let apart = apart_mm / upsampling.near_mm;
    return weight / (1.0 + apart * apart) + 1e-5 / (1.0 + abs(apart));
}
