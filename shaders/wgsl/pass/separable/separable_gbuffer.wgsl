// Where the eye sees a mesh: c_l E, light of all sources that enters, weighted by the factors; and S_m so far, what comes
// through from behind. Depth is in the fourth place.

@fragment
fn weigh(in: Varying) -> MapsAndSums {
    let change = step_of(in.position_mm, in.uv);
    let normal = normalize(in.normal);
    var c = factors_at(in.position_mm, normal, in.uv, change);
    let depth = depth_of(in.position_mm);
    var e = vec3<f32>(0.0);
    var sums: array<vec4<f32>, TERMS>;
    for (var i = 0u; i < scene.lights; i++) {
        let from_light = incident(i, in.position_mm);
        let share = entering(normal, from_light.towards);
        // What faces the light has it from the blurred maps.
        let facing_away = clamp(-dot(normal, from_light.towards), 0.0, 1.0);
        if share > 0.0 {
            e += from_light.irradiance * share * visibility(i, in.position_mm, normal);
        }
        if facing_away > 0.0 {
            var came = come_through(i, in.position_mm);
            for (var m = 0u; m < TERMS; m++) {
                sums[m] += vec4<f32>(facing_away * came[m], 0.0);
            }
        }
    }
    var maps: array<vec4<f32>, TERMS>;
    for (var l = 0u; l < TERMS; l++) {
        maps[l] = vec4<f32>(min(c[l] * e, BRIGHTEST), depth);
        sums[l].w = depth;
    }
    return maps_and_sums_of(maps, sums);
}
