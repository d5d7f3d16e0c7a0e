// Needs: <target format>, fullscreen, tsm.
// Next mipmap level of the translucent shadow maps: four texels become one.

@group(0) @binding(0) var<uniform> tsm_light: TsmLight;
@group(0) @binding(1) var positions: TargetTexture;
@group(0) @binding(2) var fluxes: TargetTexture;
@group(0) @binding(3) var uvs: TargetTexture;

@fragment
fn tsm_reduce(@builtin(position) at: vec4<f32>) -> TsmTexel {
    let texel = vec2<u32>(at.xy);
    let last = textureDimensions(positions) - 1u;
    var position = vec4<f32>(0.0);
    var flux = vec4<f32>(0.0);
    var uv = vec2<f32>(0.0);
    var range = vec2<f32>(60000.0, -60000.0);
    // Indices of base materials cannot be averaged: one of the four stands for all, another one from texel to texel.
    let chosen = (texel.x * 7u + texel.y * 13u + ((texel.x ^ texel.y) >> 1u)) & 3u;
    for (var k = 0u; k < 4u; k++) {
        let turn = (k + chosen) & 3u;
        let child = min(2u * texel + vec2<u32>(turn & 1u, turn >> 1u), last);
        var child_flux = unpack(textureLoad(fluxes, child, 0));
        if tsm_light.level == 1u {
            child_flux.w = select(0.0, 1.0, abs(child_flux.w - tsm_light.group) < 0.5);
        }
        if child_flux.w > 0.0 {
            let child_uv = unpack(textureLoad(uvs, child, 0));
            position += child_flux.w * unpack(textureLoad(positions, child, 0));
            range = vec2<f32>(min(range.x, child_uv.z), max(range.y, child_uv.w));
            if flux.w == 0.0 {
                uv = child_uv.xy;
            }
            flux += 0.25 * vec4<f32>(child_flux.xyz, child_flux.w);
        }
    }
    if flux.w == 0.0 {
        return TsmTexel(pack(vec4<f32>(60000.0, 0.0, 0.0, 0.0)), pack(vec4<f32>(0.0)), pack(vec4<f32>(0.0)));
    }
    return TsmTexel(pack(0.25 * position / flux.w), pack(flux), pack(vec4<f32>(uv, range)));
}
