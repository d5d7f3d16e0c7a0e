// Needs: <target format>, tone, display, fresnel, object, scene, coat, mapping, host_shadow, tsm_visibility, patch_layers, visibilities, vertex_none, vertex, neighbours, upsampling, shading, linsss.
// Picture of a mesh by LinSSS: M = 1/2 sum over h of (W_h (G_h * E) + G_h * (W_h E)), light from behind, and that of the environment.

@group(1) @binding(3) var<uniform> linsss: Linsss;
// G_h * E and G_h * (W_h E), a layer each.
@group(1) @binding(4) var light: TargetTextureArray;
@group(1) @binding(5) var weighted: TargetTextureArray;
// Light from behind; depth in mm in the fourth channel.
@group(1) @binding(6) var through: TargetTexture;

// Exitance of a fragment; linear Rec. 709.
fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    let at = lookup_of(in);
    let count = min(linsss.gaussians, MAX_LINSSS_GAUSSIANS);
    var own: array<vec3<f32>, MAX_LINSSS_GAUSSIANS>;
    for (var h = 0u; h < count; h++) {
        own[h] = layer_at(h, at);
    }
    let depth = depth_of(in.position_mm);
    let coord = bilinear_coord(in.clip.xy);
    var total = vec3<f32>(0.0);
    var weights = 0.0;
    for (var k = 0u; k < NEIGHBOURS; k++) {
        if k == 4u && weights > ENOUGH {
            break;
        }
        let texel = clamp(coord.first + neighbour(k), vec2<i32>(0), upsampling.last);
        let behind = unpack(textureLoad(through, texel, 0));
        let weight = near_weight(linear_weight(k, coord.part), (behind.w - depth) / upsampling.near_mm);
        weights += weight;
        var sum = behind.xyz;
        for (var h = 0u; h < count; h++) {
            sum += 0.5 * own[h] * unpack(textureLoad(light, texel, h, 0)).xyz;
            if linsss.is_exact != 0u {
                sum += 0.5 * unpack(textureLoad(weighted, texel, h, 0)).xyz;
            }
        }
        total += weight * sum;
    }
    let albedo = layer_at(linsss.gaussians, at);
    return max(total / weights + albedo * scattered_sky(in, normal), vec3<f32>(0.0));
}

// Visibility of light `i`, 0 to 1.
fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    return visibility(i, in.position_mm, normal);
}

@fragment
fn shade_linsss(in: Varying) -> @location(0) vec4<f32> {
    return shaded(in);
}
