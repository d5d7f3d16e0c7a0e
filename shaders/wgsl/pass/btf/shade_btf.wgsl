// Needs: <target format>, <BTF layout>, tone, display, fresnel, object, scene, coat, host_shadow, tsm_visibility, btf_vertex, btf_texture, btf_tangents, <ambient>.
// Picture of a mesh of a BTF: light of the sources and of the environment that it reflects.

@fragment
fn shade_btf(in: Varying) -> @location(0) vec4<f32> {
    let lod = level_of_detail(dpdx(in.uv), dpdy(in.uv));
    let plane = cross(dpdx(in.position_mm), dpdy(in.position_mm));
    let to_eye = normalize(scene.eye_mm - in.position_mm);
    let tangents = tangents_of(in, plane, to_eye);
    let eye = view_coord(into_material(tangents, to_eye));
    var light = ambient_light(in, lod, eye, tangents);
    for (var i = 0u; i < scene.lights; i++) {
        let from_light = incident(i, in.position_mm);
        if dot(tangents.z, from_light.towards) > 0.0 {
            let reached = from_light.irradiance * visibility(i, in.position_mm, tangents.z);
            light += reached * filtered_btf(in.uv, lod, into_material(tangents, from_light.towards), eye);
        }
    }
    return vec4<f32>(display_value(light / PI * scene.exposure), 1.0);
}
