// Light that is transmitted through thin parts of a homogeneous material, from the translucent shadow maps or by the thickness that the
// host's maps tell (Jimenez et al. 2010, "Real-time realistic skin translucency", for any profile).

// T of the nodes, at radius (k / last)^2 mm; linear Rec. 709.
@group(1) @binding(1) var tail: texture_2d<f32>;
// Irradiance that enters, on a plane across the axis of the light.
@group(1) @binding(2) var tsm_fluxes: TargetTexture;

// Share of light that comes through a plate of d mm: T(d), between nodes linear in the root of d.
fn tail_at(d: f32) -> vec3<f32> {
    let place = sqrt(max(d, 0.0) / profile.radius_mm) * f32(profile.last_node);
    let node = min(u32(min(place, 65535.0)), profile.last_node - 1u);
    let low = textureLoad(tail, vec2<u32>(node, 0u), 0).xyz;
    let high = textureLoad(tail, vec2<u32>(node + 1u, 0u), 0).xyz;
    return mix(low, high, clamp(place - f32(node), 0.0, 1.0));
}

// Light of source i that enters d away along the light and reaches a position in mm.
fn transmitted_of_map(i: u32, position_mm: vec3<f32>) -> vec3<f32> {
    let coord = tsm_coord(i, position_mm);
    let depth = light_depth(i, position_mm);
    let reach = spread_texels(profile.spread_mm, coord.texel_mm);
    var total = vec3<f32>(0.0);
    for (var k = 0; k < 9; k++) {
        let step = vec2<i32>(k % 3 - 1, k / 3 - 1);
        let texel = tsm_texel(i, vec2<i32>(floor(coord.texel + vec2<f32>(step) * reach)));
        let flux = unpack(textureLoad(tsm_fluxes, texel, 0));
        let d = abs(depth - unpack(textureLoad(tsm_positions, texel, 0)).x);
        // Light that enters other groups does not come out of this one.
        total += flux.xyz * select(0.0, 1.0, is_of_group(flux.w)) * spread_weight(step) * tail_at(d);
    }
    return total;
}

// The same by a map of the host's, which tells the distance alone: there the light is taken to enter as large an angle from the normal
// as here. `facing_away` is the cosine here.
fn transmitted_by_host(i: u32, position_mm: vec3<f32>, facing_away: f32) -> vec3<f32> {
    let from_light = incident(i, position_mm);
    let coord = host_coord(i, position_mm);
    if !coord.is_inside {
        return vec3<f32>(0.0);
    }
    let ray = host_ray(i, position_mm, from_light.towards);
    let reach = spread_texels(profile.spread_mm, coord.texel_mm);
    var total = vec3<f32>(0.0);
    for (var k = 0; k < 9; k++) {
        let step = vec2<i32>(k % 3 - 1, k / 3 - 1);
        let depth = host_depth(i, coord, floor(coord.texel + vec2<f32>(step) * reach));
        let d = thickness(ray, depth);
        if d >= 0.0 {
            total += spread_weight(step) * tail_at(d);
        }
    }
    return total * from_light.irradiance * fresnel_transmittance(facing_away, object.eta);
}

// Light of source i that comes through from behind to a position in mm; `facing_away` is the cosine of the normal and the direction away
// from the light. Where nothing tells the thickness, none does.
fn transmitted(i: u32, position_mm: vec3<f32>, facing_away: f32) -> vec3<f32> {
    let shadow = scene.light[min(i, MAX_LIGHTS - 1u)].shadow;
    if shadow == OWN_SHADOW {
        return transmitted_of_map(i, position_mm);
    }
    if HOST_SHADOWS && shadow != NO_SHADOW {
        return transmitted_by_host(i, position_mm, facing_away);
    }
    return vec3<f32>(0.0);
}
