// Needs: <target format>, <terms>, fullscreen, screen, domain_screen, blur, stage_sum.
// Sum over the stages of the cascade on the screen so far, once one of them is through.

@fragment
fn sum_screen(@builtin(position) at: vec4<f32>) -> Maps {
    return maps_of(summed(vec2<u32>(at.xy), maps_at(vec2<i32>(at.xy))));
}
