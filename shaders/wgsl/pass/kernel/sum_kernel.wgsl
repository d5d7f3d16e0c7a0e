// Needs: <target format>, fullscreen, screen, kernel.
// Blur by a term of a separable kernel along columns, and the sum over the terms so far.

// Light transmitted from behind, and the terms before; depth in mm in the fourth channel.
@group(0) @binding(3) var sums: TargetTexture;

@fragment
fn sum_kernel(@builtin(position) at: vec4<f32>) -> @location(0) TargetTexel {
    let light = blurred(vec2<i32>(at.xy));
    let sum = unpack(textureLoad(sums, vec2<i32>(at.xy), 0)).xyz + term.sign.xyz * light.xyz;
    // Within half floats: infinities of both signs would meet.
    return pack(vec4<f32>(clamp(sum, vec3<f32>(-60000.0), vec3<f32>(60000.0)), light.w));
}
