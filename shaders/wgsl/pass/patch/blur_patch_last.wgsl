// The second axis of the last stage, and the exitance of a flat patch: M = sum over m of c_m S_m.

// c_m of every pixel; linear rgb, mm^-1.
@group(0) @binding(4) var factors: texture_2d_array<f32>;

@fragment
fn blur(@builtin(position) at: vec4<f32>) -> @location(0) Kept {
    let texel = vec2<u32>(at.xy);
    var total = summed(texel, blurred(vec2<i32>(at.xy)));
    var exitance = vec3<f32>(0.0);
    for (var m = 0u; m < TERMS; m++) {
        exitance += textureLoad(factors, texel, m, 0).xyz * total[m].xyz;
    }
    return kept(vec4<f32>(exitance, 1.0));
}
