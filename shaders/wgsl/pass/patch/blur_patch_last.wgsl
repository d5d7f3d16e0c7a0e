// Needs: <target format>, <terms>, fullscreen, domain_patch, blur, maps_stage, stage_sum.
// Last stage of the cascade on a flat patch, along columns, and the exitance: M = sum over m of c_m S_m.

// c_m of every pixel; linear Rec. 709, mm^-1.
@group(0) @binding(4) var coefficients: texture_2d_array<f32>;

@fragment
fn blur_patch_last(@builtin(position) at: vec4<f32>) -> @location(0) TargetTexel {
    let texel = vec2<u32>(at.xy);
    var total = summed(texel, blurred(vec2<i32>(at.xy)));
    var exitance = vec3<f32>(0.0);
    for (var m = 0u; m < TERMS; m++) {
        exitance += textureLoad(coefficients, texel, m, 0).xyz * total[m].xyz;
    }
    return pack(vec4<f32>(exitance, 1.0));
}
