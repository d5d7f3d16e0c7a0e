// Needs: <target format>, fullscreen.
// Plain copy of a map, texel by texel: what blurs are timed against.

@group(0) @binding(0) var map: TargetTexture;

@fragment
fn copy(@builtin(position) at: vec4<f32>) -> @location(0) TargetTexel {
    return pack(unpack(textureLoad(map, vec2<i32>(at.xy), 0)));
}
