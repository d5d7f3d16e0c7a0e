// Needs: <target format>, fullscreen, tone.
// Picture of a flat patch: exitance, scaled and tone-mapped, every texel a block of pixels.

struct Frame {
    // Pixels of the picture and texels of the patch.
    size: vec2<u32>,
    texels: vec2<u32>,
    // Factor of the exitance before tone mapping.
    exposure: f32,
    pad_0: f32,
    pad_1: f32,
    pad_2: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var exitance: TargetTexture;

@fragment
fn present(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = vec2<u32>(at.xy) * frame.texels / frame.size;
    let light = unpack(textureLoad(exitance, min(texel, frame.texels - 1u), 0)).xyz;
    return vec4<f32>(srgb(neutral(light * frame.exposure)), 1.0);
}
