// Needs: <target format>, <terms>, fullscreen, screen, domain_screen, blur, stage_sum.
// Last stage of the cascade on the screen, along columns, and the sum over all stages.

@fragment
fn blur_screen_last(@builtin(position) at: vec4<f32>) -> Maps {
    return maps_of(summed(vec2<u32>(at.xy), blurred(vec2<i32>(at.xy))));
}
