// Needs: <target format>, <terms>, fresnel, object, scene, mapping, host_shadow, tsm_visibility, patch_layers, separable_basis, visibilities, vertex_none, vertex, spread, volume, volume_sums, transmission.
// G-buffer for the separable blurs on the screen: c_l E of the light that enters, and S_m of the light that is transmitted
// from behind and of what spreads in the light volume; depth in mm in the fourth channel.

@fragment
fn separable_gbuffer(in: Varying) -> MapsAndSums {
    let normal = normalize(in.normal);
    var c = basis_at(lookup_of(in));
    let depth = depth_of(in.position_mm);
    let is_spread = volume.first < transmission.gaussians;
    // The narrowest Gaussian alone does not reach through anything.
    let is_transmitted = !is_spread || volume.first > 1u;
    var e = vec3<f32>(0.0);
    var sums: array<vec4<f32>, TERMS>;
    for (var i = 0u; i < scene.lights; i++) {
        let from_light = incident(i, in.position_mm);
        let share = entering(normal, from_light.towards);
        // Surfaces that face the light have its light from the blurred maps.
        let facing_away = clamp(-dot(normal, from_light.towards), 0.0, 1.0);
        if share > 0.0 {
            e += from_light.irradiance * share * visibility(i, in.position_mm, normal);
        }
        if facing_away > 0.0 && is_transmitted {
            var from_behind = transmitted(i, in.position_mm, facing_away, c);
            for (var m = 0u; m < TERMS; m++) {
                sums[m] += vec4<f32>(facing_away * from_behind[m], 0.0);
            }
        }
    }
    if is_spread {
        var spread = volume_sums_at(in.position_mm);
        for (var m = 0u; m < TERMS; m++) {
            sums[m] += vec4<f32>(spread[m], 0.0);
        }
    }
    var maps: array<vec4<f32>, TERMS>;
    for (var l = 0u; l < TERMS; l++) {
        maps[l] = vec4<f32>(clamp(c[l] * e, -BRIGHTEST, BRIGHTEST), depth);
        sums[l] = vec4<f32>(clamp(sums[l].xyz, -BRIGHTEST, BRIGHTEST), depth);
    }
    return maps_and_sums_of(maps, sums);
}
