// The next level of what a light sees: four texels become one.

@group(0) @binding(0) var<uniform> which: Which;
@group(0) @binding(1) var positions: KeptLayers;
@group(0) @binding(2) var fluxes: KeptLayers;
@group(0) @binding(3) var places: KeptLayers;

@fragment
fn reduce(@builtin(position) at: vec4<f32>) -> Seen {
    let texel = vec2<u32>(at.xy);
    let last = textureDimensions(positions) - 1u;
    var position = vec4<f32>(0.0);
    var flux = vec4<f32>(0.0);
    var place = vec2<f32>(0.0);
    var range = vec2<f32>(60000.0, -60000.0);
    // Indices cannot be averaged: one of the four stands for all, another one from texel to texel.
    let chosen = (texel.x * 7u + texel.y * 13u + ((texel.x ^ texel.y) >> 1u)) & 3u;
    for (var k = 0u; k < 4u; k++) {
        let turn = (k + chosen) & 3u;
        let child = min(2u * texel + vec2<u32>(turn & 1u, turn >> 1u), last);
        let child_flux = told(textureLoad(fluxes, child, which.light, 0));
        if child_flux.w > 0.0 {
            let child_place = told(textureLoad(places, child, which.light, 0));
            position += child_flux.w * told(textureLoad(positions, child, which.light, 0));
            range = vec2<f32>(min(range.x, child_place.z), max(range.y, child_place.w));
            if flux.w == 0.0 {
                place = child_place.xy;
            }
            flux += 0.25 * vec4<f32>(child_flux.xyz, child_flux.w);
        }
    }
    if flux.w == 0.0 {
        return Seen(kept(vec4<f32>(0.0, 0.0, 0.0, 60000.0)), kept(vec4<f32>(0.0)), kept(vec4<f32>(0.0)));
    }
    return Seen(kept(0.25 * position / flux.w), kept(flux), kept(vec4<f32>(place, range)));
}
