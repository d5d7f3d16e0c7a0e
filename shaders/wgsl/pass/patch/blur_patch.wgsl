// Needs: <target format>, <terms>, fullscreen, domain_patch, blur, maps_stage.
// Stages of the cascade on a flat patch, along rows or along columns, but for the first and the last.

@fragment
fn blur_patch(@builtin(position) at: vec4<f32>) -> Maps {
    return maps_of(blurred(vec2<i32>(at.xy)));
}
