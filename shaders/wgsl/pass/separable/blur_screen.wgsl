// Needs: <target format>, <terms>, fullscreen, screen, domain_screen, blur.
// Stages of the cascade on the screen, along rows or along columns.

@fragment
fn blur_screen(@builtin(position) at: vec4<f32>) -> Maps {
    return maps_of(blurred(vec2<i32>(at.xy)));
}
