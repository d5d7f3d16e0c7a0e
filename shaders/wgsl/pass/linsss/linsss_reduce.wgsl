// Needs: <target format>, fullscreen, linsss_stage.
// Next level of the pyramid of light, by weights along both axes and by nearness in depth: level 1 is blurred by half a texel,
// level 2 by one; from there on each is half as large as the one before and blurred by one of its own texels.

// The level before; depth in mm in the fourth channel.
@group(0) @binding(1) var finer: TargetTexture;

// Variance 1/4.
const TO_HALF_A_TEXEL: array<f32, 8> = array<f32, 8>(0.125, 0.75, 0.125, 0.0, 0.0, 0.0, 0.0, 0.0);
// Variance 3/4: twice (3/16, 5/8, 3/16).
const TO_A_TEXEL: array<f32, 8> = array<f32, 8>(0.03515625, 0.234375, 0.4609375, 0.234375, 0.03515625, 0.0, 0.0, 0.0);
// Variance 3: (1, 3, 3, 1) / 8, which halves, and (9/32, 7/16, 9/32) of what is halved.
const HALVING: array<f32, 8> =
    array<f32, 8>(0.03515625, 0.10546875, 0.16015625, 0.19921875, 0.19921875, 0.16015625, 0.10546875, 0.03515625);

fn finer_at(texel: vec2<i32>) -> vec4<f32> {
    return unpack(textureLoad(finer, clamp(texel, vec2<i32>(0), last_of(stage.level - 1u)), 0));
}

@fragment
fn linsss_reduce(@builtin(position) at: vec4<f32>) -> @location(0) TargetTexel {
    let x = vec2<i32>(at.xy);
    var taps = HALVING;
    var count = 8;
    var first = 2 * x - 3;
    var middle = 2 * x;
    var middles = 4;
    if stage.level <= 2u {
        taps = TO_A_TEXEL;
        count = 5;
        first = x - 2;
        middle = x;
        middles = 1;
    }
    if stage.level == 1u {
        taps = TO_HALF_A_TEXEL;
        count = 3;
        first = x - 1;
    }
    // Depth of the first of those in the middle that is no background.
    var depth = finer_at(middle).w;
    for (var k = 1; k < middles; k++) {
        let other = finer_at(middle + vec2<i32>(k % 2, k / 2)).w;
        depth = select(depth, other, depth > BACKGROUND_MM);
    }
    if depth > BACKGROUND_MM {
        return pack(vec4<f32>(0.0, 0.0, 0.0, depth));
    }
    let scale = texels_per_mm(depth);
    let width_mm = sqrt(variance_of(stage.level) / (scale.x * scale.y));
    var sum = vec4<f32>(0.0);
    var weights = 0.0;
    for (var row = 0; row < count; row++) {
        for (var column = 0; column < count; column++) {
            let other = finer_at(first + vec2<i32>(column, row));
            let weight = taps[row] * taps[column] * nearness_of(other.w - depth, vec3<f32>(width_mm)).x;
            weights += weight;
            sum += weight * other;
        }
    }
    return pack(sum / max(weights, 1e-6));
}
