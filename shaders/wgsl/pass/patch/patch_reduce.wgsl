// Needs: <target format>, fullscreen.
// Next mipmap level of up to three layers over a patch: means over the texels, and parts of texels, that each texel covers.

// The level before, all layers.
@group(0) @binding(0) var finer: texture_2d_array<f32>;

struct Layers {
    @location(0) first: TargetTexel,
    @location(1) second: TargetTexel,
    @location(2) third: TargetTexel,
}

// Texels of the finer level along one axis that a texel covers: the first, the last, and how much of both.
struct Span {
    first: u32,
    last: u32,
    low: f32,
    high: f32,
}

// Span of texel x of `to` over `from` texels.
fn span(x: u32, from_texels: u32, to: u32) -> Span {
    let step = f32(from_texels) / f32(to);
    let low = f32(x) * step;
    let high = f32(x + 1u) * step;
    return Span(min(u32(low), from_texels - 1u), min(u32(ceil(high)), from_texels) - 1u, low, high);
}

// Part of texel x within a span.
fn part(span: Span, x: u32) -> f32 {
    return max(min(span.high, f32(x + 1u)) - max(span.low, f32(x)), 0.0);
}

@fragment
fn patch_reduce(@builtin(position) at: vec4<f32>) -> Layers {
    let texel = vec2<u32>(at.xy);
    let size = textureDimensions(finer);
    let half = max(size / 2u, vec2<u32>(1u));
    let across = span(texel.x, size.x, half.x);
    let down = span(texel.y, size.y, half.y);
    let last = u32(textureNumLayers(finer)) - 1u;
    var sums: array<vec3<f32>, 3>;
    var weights = 0.0;
    for (var y = down.first; y <= down.last; y++) {
        for (var x = across.first; x <= across.last; x++) {
            let weight = part(across, x) * part(down, y);
            weights += weight;
            for (var l = 0u; l < 3u; l++) {
                sums[l] += weight * textureLoad(finer, vec2<u32>(x, y), min(l, last), 0).xyz;
            }
        }
    }
    return Layers(
        pack(vec4<f32>(sums[0] / weights, 1.0)),
        pack(vec4<f32>(sums[1] / weights, 1.0)),
        pack(vec4<f32>(sums[2] / weights, 1.0)),
    );
}
