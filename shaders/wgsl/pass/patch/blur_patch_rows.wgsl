// Needs: <target format>, <terms>, fullscreen, domain_patch, blur, maps_stage.
// Later stages of the cascade on a flat patch, along rows.

@fragment
fn blur_patch_rows(@builtin(position) at: vec4<f32>) -> Maps {
    return maps_of(blurred(vec2<i32>(at.xy)));
}
