// Needs: <target format>, fullscreen, linsss_stage.
// Light blurred by one Gaussian, as the pyramid has it between two of its levels, each channel by its own sigma.

// Levels 0 and 1, and all others; depth in mm in the fourth channel.
@group(0) @binding(1) var light: TargetTexture;
@group(0) @binding(2) var slight: TargetTexture;
@group(0) @binding(3) var pyramid: TargetTexture;

// A level at a texel of the finest, linear between texels of like depth.
fn level_at(level: u32, texel: vec2<i32>, depth: f32, sigma_mm: f32) -> vec3<f32> {
    if level == 0u {
        return unpack(textureLoad(light, texel, 0)).xyz;
    }
    if level == 1u {
        return unpack(textureLoad(slight, texel, 0)).xyz;
    }
    let place = (vec2<f32>(texel) + 0.5) / f32(1u << (level - 2u)) - 0.5;
    let first = vec2<i32>(floor(place));
    let part = place - floor(place);
    let last = last_of(level);
    var sum = vec3<f32>(0.0);
    var weights = 0.0;
    for (var k = 0; k < 4; k++) {
        let step = vec2<i32>(k % 2, k / 2);
        let each = mix(1.0 - part, part, vec2<f32>(step));
        let value = unpack(textureLoad(pyramid, clamp(first + step, vec2<i32>(0), last), i32(level - 2u)));
        let weight = each.x * each.y * nearness_of(value.w - depth, vec3<f32>(sigma_mm)).x + 1e-6;
        weights += weight;
        sum += weight * value.xyz;
    }
    return sum / weights;
}

@fragment
fn linsss_lookup(@builtin(position) at: vec4<f32>) -> @location(0) TargetTexel {
    let x = vec2<i32>(at.xy);
    let depth = unpack(textureLoad(light, x, 0)).w;
    if depth > BACKGROUND_MM {
        return pack(vec4<f32>(0.0, 0.0, 0.0, depth));
    }
    let scale = texels_per_mm(depth);
    var blurred = vec3<f32>(0.0);
    for (var c = 0u; c < 3u; c++) {
        var sigmas = stage.sigma_mm;
        let sigma_mm = sigmas[c];
        let wanted = sigma_mm * sigma_mm * scale.x * scale.y;
        var level = 0u;
        while level + 2u < stage.levels && variance_of(level + 1u) < wanted {
            level++;
        }
        let low = variance_of(level);
        let part = clamp((wanted - low) / (variance_of(level + 1u) - low), 0.0, 1.0);
        var both = mix(level_at(level, x, depth, sigma_mm), level_at(level + 1u, x, depth, sigma_mm), part);
        blurred[c] = both[c];
    }
    return pack(vec4<f32>(blurred, depth));
}
