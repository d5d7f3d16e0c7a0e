// Texture filter of one material of a BTF; texture coordinates repeat.

struct BtfTexture {
    // First texel, width and height of each mipmap level, the finest first.
    levels: array<vec4<u32>, 16>,
    // Number of levels, 1 to 16.
    count: u32,
    // 0 nearest texel, 1 bilinear in the nearest level, 2 trilinear.
    filtering: u32,
    // Samples of the environment for a pixel of the picture.
    samples: u32,
    pad_0: u32,
}

@group(1) @binding(2) var<uniform> btf_texture: BtfTexture;

// Texel and its weight, 0 to 1.
struct Tap {
    texel: u32,
    weight: f32,
}

// Mipmap level, not rounded, for screen-space derivatives of the texture coordinates.
fn level_of_detail(dx: vec2<f32>, dy: vec2<f32>) -> f32 {
    let size = vec2<f32>(btf_texture.levels[0].yz);
    let texels2 = max(dot(dx * size, dx * size), dot(dy * size, dy * size));
    return clamp(0.5 * log2(max(texels2, 1e-12)), 0.0, f32(btf_texture.count - 1u));
}

// Number of taps of a pixel; some may have no weight.
fn tap_count() -> u32 {
    if btf_texture.filtering == 0u {
        return 1u;
    }
    return select(4u, 8u, btf_texture.filtering == 2u && btf_texture.count > 1u);
}

// Tap k: texel (k & 1, k >> 1 & 1) of the four around; of the finer level for k < 4.
fn tap_at(k: u32, uv: vec2<f32>, lod: f32) -> Tap {
    let finer = floor(lod + select(0.5, 0.0, btf_texture.filtering == 2u));
    let part = clamp(lod - finer, 0.0, 1.0);
    let of_level = btf_texture.levels[min(u32(finer) + (k >> 2u), btf_texture.count - 1u)];
    let size = vec2<i32>(of_level.yz);
    let at = fract(uv) * vec2<f32>(size);
    if btf_texture.filtering == 0u {
        let nearest = min(vec2<u32>(at), of_level.yz - 1u);
        return Tap(of_level.x + nearest.y * of_level.y + nearest.x, 1.0);
    }
    let low = floor(at - 0.5);
    let shares = at - 0.5 - low;
    let corner = vec2<u32>(k & 1u, (k >> 1u) & 1u);
    let texel = vec2<i32>(low) + vec2<i32>(corner);
    // Wrapped from -1 .. size to 0 .. size - 1.
    let x = select(texel.x, texel.x + select(size.x, -size.x, texel.x > 0), texel.x < 0 || texel.x >= size.x);
    let y = select(texel.y, texel.y + select(size.y, -size.y, texel.y > 0), texel.y < 0 || texel.y >= size.y);
    let weight = select(1.0 - shares.x, shares.x, corner.x == 1u) * select(1.0 - shares.y, shares.y, corner.y == 1u);
    var of_levels = 1.0;
    if btf_texture.filtering == 2u {
        of_levels = select(1.0 - part, part, k >= 4u);
    }
    return Tap(of_level.x + u32(y) * of_level.y + u32(x), weight * of_levels);
}

// Texel of the tap that a random number, 0 to 1, selects in proportion to the weights.
fn random_tap(uv: vec2<f32>, lod: f32, chance: f32) -> u32 {
    var left = chance;
    var texel = 0u;
    for (var k = 0u; k < tap_count(); k++) {
        let tap = tap_at(k, uv, lod);
        if tap.weight > 0.0 && left >= 0.0 {
            texel = tap.texel;
        }
        left -= tap.weight;
    }
    return texel;
}

// Value of the BTF, as `btf_value`, filtered over the taps.
fn filtered_btf(uv: vec2<f32>, lod: f32, light: vec3<f32>, eye: ViewCoord) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < tap_count(); k++) {
        let tap = tap_at(k, uv, lod);
        if tap.weight > 0.0 {
            sum += tap.weight * btf_value(apparent_brdf(tap.texel, eye), light, eye);
        }
    }
    return sum;
}
