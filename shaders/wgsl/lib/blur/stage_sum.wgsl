// Sum over the stages, once both axes are blurred: S_m += sum over l of w_lma [G_a * (c_l E)].

// S_m of the stages before; depth in mm in the fourth channel.
@group(0) @binding(3) var sums: TargetMaps;

// S_m with the share of this stage, from its blurred maps.
fn summed(texel: vec2<u32>, maps: array<vec4<f32>, TERMS>) -> array<vec4<f32>, TERMS> {
    // Only variables can be indexed by what is not constant.
    var light = maps;
    var total: array<vec4<f32>, TERMS>;
    for (var m = 0u; m < TERMS; m++) {
        var sum = select(vec3<f32>(0.0), load_map(sums, vec2<i32>(texel), m).xyz, has_sum());
        for (var l = 0u; l < TERMS; l++) {
            sum += stage.weights[2u * l + m].xyz * light[l].xyz;
        }
        // Within half floats: infinities of both signs would meet.
        total[m] = vec4<f32>(clamp(sum, vec3<f32>(-60000.0), vec3<f32>(60000.0)), light[0].w);
    }
    return total;
}
