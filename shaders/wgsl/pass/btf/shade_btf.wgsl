// The picture of a mesh of a BTF: what it reflects of lights and of light from all around, tone-mapped.

@fragment
fn shade(in: Varying) -> @location(0) vec4<f32> {
    let detail = detail_of(dpdx(in.uv), dpdy(in.uv));
    let plane = cross(dpdx(in.position_mm), dpdy(in.position_mm));
    let to_eye = normalize(scene.eye_mm - in.position_mm);
    let tangents = tangents_of(in, plane, to_eye);
    let seen = seen_from(into_material(tangents, to_eye));
    var light = from_all_around(in, detail, seen, tangents);
    for (var i = 0u; i < scene.lights; i++) {
        let from_light = incident(i, in.position_mm);
        if dot(tangents.z, from_light.towards) > 0.0 {
            let reached = from_light.irradiance * visibility(i, in.position_mm, tangents.z);
            light += reached * textured(in.uv, detail, into_material(tangents, from_light.towards), seen);
        }
    }
    return vec4<f32>(encoded(neutral(light / PI * scene.exposure)), 1.0);
}
