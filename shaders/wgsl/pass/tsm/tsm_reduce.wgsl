// Needs: <target format>, fullscreen, tsm.
// Next mipmap level of the translucent shadow maps: four texels become one.

@group(0) @binding(0) var<uniform> tsm_light: TsmLight;
@group(0) @binding(1) var positions: TargetTexture;
@group(0) @binding(2) var fluxes: TargetTexture;
@group(0) @binding(3) var uvs: TargetTexture;

// Range of depths, in distances across the light between the middle of a texel and that of its parts, from which on surfaces lie apart: the
// middle of what a light sees of both would be in the air.
const APART: f32 = 12.0;
// Weight of parts into which no light enters, should there be no others.
const UNLIT: f32 = 1e-6;

@fragment
fn tsm_reduce(@builtin(position) at: vec4<f32>) -> TsmTexel {
    let texel = vec2<u32>(at.xy);
    let last = textureDimensions(positions) - 1u;
    // Weights are of the light that enters.
    var weights: array<f32, 4>;
    var places: array<vec4<f32>, 4>;
    var patch_places: array<vec2<f32>, 4>;
    var total = 0.0;
    var position = vec4<f32>(0.0);
    var flux = vec4<f32>(0.0);
    var range = vec2<f32>(60000.0, -60000.0);
    for (var k = 0u; k < 4u; k++) {
        let child = min(2u * texel + vec2<u32>(k & 1u, k >> 1u), last);
        var child_flux = unpack(textureLoad(fluxes, child, 0));
        if tsm_light.level == 1u {
            child_flux.w = select(0.0, 1.0, abs(child_flux.w - tsm_light.group) < 0.5);
        }
        if child_flux.w > 0.0 {
            let child_uv = unpack(textureLoad(uvs, child, 0));
            weights[k] = child_flux.x + child_flux.y + child_flux.z + UNLIT * child_flux.w;
            places[k] = unpack(textureLoad(positions, child, 0));
            patch_places[k] = child_uv.xy;
            total += weights[k];
            position += weights[k] * places[k];
            range = vec2<f32>(min(range.x, child_uv.z), max(range.y, child_uv.w));
            flux += 0.25 * vec4<f32>(child_flux.xyz, child_flux.w);
        }
    }
    if flux.w == 0.0 {
        return TsmTexel(pack(vec4<f32>(60000.0, 0.0, 0.0, 0.0)), pack(vec4<f32>(0.0)), pack(vec4<f32>(0.0)));
    }
    position /= total;
    // Places on the patch cannot be averaged: one of the four stands for all, by chance, as often as it has light. Steps by the
    // generalised golden ratio in two dimensions spread the choices evenly (Roberts 2018), the same in every tile.
    let chance = total * fract(0.5 + dot(vec2<f32>(texel & vec2<u32>(15u)), vec2<f32>(0.75487766, 0.56984029)));
    var chosen = 0u;
    var before = 0.0;
    var across2 = 0.0;
    for (var k = 0u; k < 4u; k++) {
        if weights[k] > 0.0 {
            chosen = select(chosen, k, before <= chance);
            before += weights[k];
            let away = places[k] - position;
            across2 = max(across2, dot(away.yzw, away.yzw) - away.x * away.x);
        }
    }
    let depths = range.y - range.x;
    if depths * depths > APART * APART * across2 {
        position = places[chosen];
    }
    return TsmTexel(pack(position), pack(flux), pack(vec4<f32>(patch_places[chosen], range)));
}
