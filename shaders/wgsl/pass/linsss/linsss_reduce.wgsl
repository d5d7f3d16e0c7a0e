// Needs: <target format>, fullscreen, linsss_stage.
// Next level of the pyramid of light: four by four texels by binomial weights and by nearness in depth.

// The level before; depth in mm in the fourth channel.
@group(0) @binding(1) var finer: TargetTexture;

fn finer_at(texel: vec2<i32>) -> vec4<f32> {
    // Texels that hold anything, at the size of the level before.
    let last = ((stage.size - 1) >> vec2<u32>(stage.level - 1u));
    return unpack(textureLoad(finer, clamp(texel, vec2<i32>(0), last), 0));
}

@fragment
fn linsss_reduce(@builtin(position) at: vec4<f32>) -> @location(0) TargetTexel {
    let first = 2 * vec2<i32>(at.xy) - 1;
    // Depth of the first of the four in the middle that is no background.
    var depth = finer_at(first + 1).w;
    for (var k = 1; k < 4; k++) {
        let other = finer_at(first + 1 + vec2<i32>(k % 2, k / 2)).w;
        depth = select(depth, other, depth > BACKGROUND_MM);
    }
    if depth > BACKGROUND_MM {
        return pack(vec4<f32>(0.0, 0.0, 0.0, depth));
    }
    // The level's own width in mm.
    let scale = texels_per_mm(depth);
    let width_mm = f32(1u << stage.level) / min(scale.x, scale.y);
    var sum = vec3<f32>(0.0);
    var weights = 0.0;
    for (var k = 0; k < 16; k++) {
        let step = vec2<i32>(k % 4, k / 4);
        let other = finer_at(first + step);
        let taps = select(vec2<f32>(1.0), vec2<f32>(3.0), (step == vec2<i32>(1)) | (step == vec2<i32>(2)));
        let weight = taps.x * taps.y * nearness_of(other.w - depth, vec3<f32>(width_mm)).x;
        weights += weight;
        sum += weight * other.xyz;
    }
    return pack(vec4<f32>(sum / max(weights, 1e-6), depth));
}
