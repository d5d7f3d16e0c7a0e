// c_l E where the eye sees a mesh: light of all sources that enters, weighted by the factors; depth in the fourth place.

@fragment
fn weigh(in: Varying) -> Maps {
    let change = step_of(in.position_mm, in.uv);
    let normal = normalize(in.normal);
    var c = factors_at(in.position_mm, normal, in.uv, change);
    var e = vec3<f32>(0.0);
    for (var i = 0u; i < scene.lights; i++) {
        let from_light = incident(i, in.position_mm);
        let share = entering(normal, from_light.towards);
        if share > 0.0 {
            e += from_light.irradiance * share * visibility(i, in.position_mm, normal);
        }
    }
    let depth = depth_of(in.position_mm);
    var maps: array<vec4<f32>, TERMS>;
    for (var l = 0u; l < TERMS; l++) {
        maps[l] = vec4<f32>(c[l] * e, depth);
    }
    return maps_of(maps);
}
