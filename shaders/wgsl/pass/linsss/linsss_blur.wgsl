// Needs: <target format>, fullscreen, linsss_stage.
// Blur of two maps by one Gaussian along one axis, each channel by its own sigma; distances are those in space.

// Depth in mm in the fourth channel of both.
@group(0) @binding(1) var light: TargetTexture;
@group(0) @binding(2) var weighted: TargetTexture;

struct Blurred {
    @location(0) light: TargetTexel,
    @location(1) weighted: TargetTexel,
}

// Most taps to one side.
const MOST_TAPS: f32 = 32.0;

@fragment
fn linsss_blur(@builtin(position) at: vec4<f32>) -> Blurred {
    let x = vec2<i32>(at.xy);
    let centre = unpack(textureLoad(light, x, 0));
    if centre.w > BACKGROUND_MM {
        let nothing = pack(vec4<f32>(0.0, 0.0, 0.0, centre.w));
        return Blurred(nothing, nothing);
    }
    let sigma = max(stage.sigma_mm.xyz * dot(texels_per_mm(centre.w), vec2<f32>(stage.axis)), vec3<f32>(1e-2));
    let narrowest = min(sigma.x, min(sigma.y, sigma.z));
    let reach = 3.2 * max(sigma.x, max(sigma.y, sigma.z));
    // Taps as far apart as the narrowest channel allows, but no more of them than there is time for.
    let sparse = max(floor(0.8 * narrowest), 1.0);
    let count = clamp(ceil(reach / sparse), 1.0, MOST_TAPS);
    let stride = i32(max(sparse, floor(reach / count)));
    var sum = vec3<f32>(0.0);
    var weighted_sum = vec3<f32>(0.0);
    var weights = vec3<f32>(0.0);
    for (var k = -i32(count); k <= i32(count); k++) {
        let texel = clamp(x + k * stride * stage.axis, vec2<i32>(0), stage.size - 1);
        let other = unpack(textureLoad(light, texel, 0));
        let distance = vec3<f32>(f32(k * stride)) / sigma;
        let weight = exp(-0.5 * distance * distance) * nearness_of(other.w - centre.w, stage.sigma_mm.xyz);
        weights += weight;
        sum += weight * other.xyz;
        weighted_sum += weight * unpack(textureLoad(weighted, texel, 0)).xyz;
    }
    return Blurred(pack(vec4<f32>(sum / weights, centre.w)), pack(vec4<f32>(weighted_sum / weights, centre.w)));
}
