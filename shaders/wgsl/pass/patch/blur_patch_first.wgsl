// Needs: <target format>, <terms>, fullscreen, domain_patch, blur, maps_irradiance.
// First stage of the cascade on a flat patch, along rows: irradiance, weighted and blurred.

@fragment
fn blur_patch_first(@builtin(position) at: vec4<f32>) -> Maps {
    return maps_of(blurred(vec2<i32>(at.xy)));
}
