// Needs: <target format>, <terms>, fullscreen, volume, blur, domain_volume.
// Stages of the cascade in a light volume, along one axis.

@fragment
fn blur_volume(@builtin(position) at: vec4<f32>) -> Maps {
    return maps_of(blurred(vec2<i32>(at.xy)));
}
