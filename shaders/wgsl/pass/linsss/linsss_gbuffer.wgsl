// Needs: <target format>, fresnel, object, scene, mapping, host_shadow, tsm_visibility, patch_layers, visibilities, vertex_none, vertex, spread, linsss.
// G-buffer for LinSSS: light E that enters, W_h E for one Gaussian, and light that comes through from behind; depth in mm in the
// fourth channel.

@group(1) @binding(2) var<uniform> linsss: Linsss;
// Irradiance that enters, on a plane across the axis of the light.
@group(1) @binding(3) var tsm_fluxes: TargetTexture;
// Texture coordinates on the patch.
@group(1) @binding(4) var tsm_uvs: TargetTexture;

struct LinsssMaps {
    @location(0) light: TargetTexel,
    @location(1) weighted: TargetTexel,
    @location(2) through: TargetTexel,
}

// Light of source i that comes through to a position in mm: a Gaussian of a plane d mm behind falls by exp(-d^2 / 2 sigma^2).
fn transmitted(i: u32, position_mm: vec3<f32>, own: array<vec3<f32>, MAX_LINSSS_GAUSSIANS>) -> vec3<f32> {
    // Only variables can be indexed by what is not constant.
    var weights = own;
    let coord = tsm_coord(i, position_mm);
    let depth = light_depth(i, position_mm);
    let widest = linsss.sigmas_mm[min(linsss.gaussians, MAX_LINSSS_GAUSSIANS) - 1u].xyz;
    let reach = spread_texels(max(widest.x, max(widest.y, widest.z)), coord.texel_mm);
    var total = vec3<f32>(0.0);
    for (var k = 0; k < 9; k++) {
        let step = vec2<i32>(k % 3 - 1, k / 3 - 1);
        let texel = tsm_texel(i, vec2<i32>(floor(coord.texel + vec2<f32>(step) * reach)));
        let flux = unpack(textureLoad(tsm_fluxes, texel, 0));
        let d = abs(depth - unpack(textureLoad(tsm_positions, texel, 0)).x);
        let uv = unpack(textureLoad(tsm_uvs, texel, 0)).xy;
        let e = flux.xyz * select(0.0, 0.5, is_of_group(flux.w)) * spread_weight(step);
        for (var h = 0u; h < min(linsss.gaussians, MAX_LINSSS_GAUSSIANS); h++) {
            let sigma = linsss.sigmas_mm[h].xyz;
            let left = exp(-0.5 * min(d * d / (sigma * sigma), vec3<f32>(80.0)));
            let entered = textureSampleLevel(layers, layer_sampler, uv, h, 1.0).xyz * f32(linsss.is_exact);
            total += e * left * (weights[h] + entered);
        }
    }
    return total;
}

@fragment
fn linsss_gbuffer(in: Varying) -> LinsssMaps {
    let at = lookup_of(in);
    let normal = normalize(in.normal);
    let depth = depth_of(in.position_mm);
    var weights: array<vec3<f32>, MAX_LINSSS_GAUSSIANS>;
    for (var h = 0u; h < min(linsss.gaussians, MAX_LINSSS_GAUSSIANS); h++) {
        weights[h] = layer_at(h, at);
    }
    var e = vec3<f32>(0.0);
    var through = vec3<f32>(0.0);
    for (var i = 0u; i < scene.lights; i++) {
        let from_light = incident(i, in.position_mm);
        let share = entering(normal, from_light.towards);
        let facing_away = clamp(-dot(normal, from_light.towards), 0.0, 1.0);
        if share > 0.0 {
            e += from_light.irradiance * share * visibility(i, in.position_mm, normal);
        }
        // Later turns have the same.
        if facing_away > 0.0 && linsss.turn == 0u && scene.light[min(i, MAX_LIGHTS - 1u)].shadow == OWN_SHADOW {
            through += facing_away * transmitted(i, in.position_mm, weights);
        }
    }
    let weighted = weights[min(linsss.turn, MAX_LINSSS_GAUSSIANS - 1u)] * e;
    return LinsssMaps(
        pack(vec4<f32>(min(e, BRIGHTEST), depth)),
        pack(vec4<f32>(min(weighted, BRIGHTEST), depth)),
        pack(vec4<f32>(min(through, BRIGHTEST), depth)),
    );
}
