// Needs: <target format>, <terms>, fullscreen, domain_screen, blur, stage_sum.
// Stages of the cascade on the screen, along columns, and the sum over the stages.

@fragment
fn blur_screen_columns(@builtin(position) at: vec4<f32>) -> MapsAndSums {
    let maps = blurred(vec2<i32>(at.xy));
    return maps_and_sums_of(maps, summed(vec2<u32>(at.xy), maps));
}
