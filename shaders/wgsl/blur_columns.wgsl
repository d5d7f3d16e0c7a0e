// The second axis, after which the stage's share is added: S_m += sum over l of w_lma [G_a * (c_l E)].

// S_m of the stages before.
@group(0) @binding(3) var sums: texture_2d_array<f32>;

@fragment
fn blur(@builtin(position) at: vec4<f32>) -> MapsAndSums {
    let texel = vec2<u32>(at.xy);
    let maps = blurred(vec2<i32>(at.xy));
    // Only variables can be indexed by what is not constant.
    var light = maps;
    var total: array<vec4<f32>, TERMS>;
    for (var m = 0u; m < TERMS; m++) {
        var sum = vec3<f32>(0.0);
        if has_sum() {
            sum = textureLoad(sums, texel, m, 0).xyz;
        }
        for (var l = 0u; l < TERMS; l++) {
            sum += stage.weights[2u * l + m].xyz * light[l].xyz;
        }
        total[m] = vec4<f32>(sum, light[0].w);
    }
    return maps_and_sums_of(maps, total);
}
