// Needs: <target format>, fullscreen, screen, kernel.
// Blur by a term of a separable kernel, along rows.

@fragment
fn blur_kernel(@builtin(position) at: vec4<f32>) -> @location(0) TargetTexel {
    return pack(blurred(vec2<i32>(at.xy)));
}
