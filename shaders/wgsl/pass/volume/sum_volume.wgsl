// Needs: <target format>, <terms>, fullscreen, volume, blur, domain_volume, stage_sum.
// Sum over the stages of the cascade in a light volume so far, once one of them is through.

@fragment
fn sum_volume(@builtin(position) at: vec4<f32>) -> Maps {
    let texel = vec2<i32>(at.xy);
    return maps_of(summed(vec2<u32>(texel), maps_at(texel)));
}
