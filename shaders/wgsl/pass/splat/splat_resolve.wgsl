// Needs: fullscreen, neighbours.
// Sum of all rings of splats: exitance divided by the albedo, which is put back at full resolution; depth in the fourth channel.

struct SplatRings {
    // Number of rings, 1 to 5.
    count: u32,
    // Difference of depth in mm by which the weight of a texel of the finest ring falls to a half.
    near_mm: f32,
    pad_0: u32,
    pad_1: u32,
}

@group(0) @binding(0) var<uniform> rings: SplatRings;
// G-buffer: positions and depth in mm, albedo in linear Rec. 709.
@group(0) @binding(1) var positions: texture_2d<f32>;
@group(0) @binding(2) var albedos: texture_2d<f32>;
// Rings, each half as large as the one before.
@group(0) @binding(3) var ring_0: texture_2d<f32>;
@group(0) @binding(4) var ring_1: texture_2d<f32>;
@group(0) @binding(5) var ring_2: texture_2d<f32>;
@group(0) @binding(6) var ring_3: texture_2d<f32>;
@group(0) @binding(7) var ring_4: texture_2d<f32>;

// Albedo that is divided by at least: darker materials are black anyway.
const LEAST_ALBEDO: f32 = 1e-4;

// Texel of a ring, clamped to its size.
fn ring_texel(number: u32, texel: vec2<i32>) -> vec3<f32> {
    switch number {
        case 0u: { return textureLoad(ring_0, min(texel, vec2<i32>(textureDimensions(ring_0)) - 1), 0).xyz; }
        case 1u: { return textureLoad(ring_1, min(texel, vec2<i32>(textureDimensions(ring_1)) - 1), 0).xyz; }
        case 2u: { return textureLoad(ring_2, min(texel, vec2<i32>(textureDimensions(ring_2)) - 1), 0).xyz; }
        case 3u: { return textureLoad(ring_3, min(texel, vec2<i32>(textureDimensions(ring_3)) - 1), 0).xyz; }
        default: { return textureLoad(ring_4, min(texel, vec2<i32>(textureDimensions(ring_4)) - 1), 0).xyz; }
    }
}

// One ring at a texel of the G-buffer: bilinear, texels at other depths left out.
fn ring_at(number: u32, texel: vec2<u32>, depth: f32) -> vec3<f32> {
    let size = vec2<i32>(textureDimensions(positions));
    let stride = i32(1u << number);
    let corner = (vec2<f32>(texel) + 0.5) / f32(stride) - 0.5;
    let first = vec2<i32>(floor(corner));
    let part = corner - floor(corner);
    var sum = vec3<f32>(0.0);
    var weights = 0.0;
    for (var k = 0u; k < NEIGHBOURS; k++) {
        if k == 4u && weights > ENOUGH {
            break;
        }
        let at = clamp(first + neighbour(k), vec2<i32>(0), (size - 1) / stride);
        // The texel that its samples were compared with.
        let seen = min(at * stride + stride / 2, size - 1);
        let apart = (textureLoad(positions, seen, 0).w - depth) / (rings.near_mm * f32(stride));
        let weight = near_weight(linear_weight(k, part), apart);
        weights += weight;
        sum += weight * ring_texel(number, at) / max(textureLoad(albedos, seen, 0).xyz, vec3<f32>(LEAST_ALBEDO));
    }
    return sum / weights;
}

@fragment
fn splat_resolve(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = vec2<u32>(at.xy);
    let depth = textureLoad(positions, texel, 0).w;
    var sum = vec3<f32>(0.0);
    if depth < 50000.0 {
        for (var number = 0u; number < min(rings.count, 5u); number++) {
            sum += ring_at(number, texel, depth);
        }
    }
    return vec4<f32>(sum, depth);
}
