// Shading of a translucent mesh under a dielectric coat. The pass has `exitance` and `light_visibility`.

// Radiance towards the eye, as the target takes it.
fn shaded(in: Varying) -> vec4<f32> {
    let to_eye = normalize(scene.eye_mm - in.position_mm);
    let normal = normalize(in.normal);
    // Scattered light, by Lambert's law with the coat's transmission on the way out.
    let reflectance = specular_ambient(clamp(abs(dot(normal, to_eye)), 0.0, 1.0));
    var radiance = exitance(in, normal) * leaving(reflectance) / PI;
    // Light that the coat reflects.
    radiance += reflectance * sky_radiance(reflect(-to_eye, normal), object.roughness);
    for (var i = 0u; i < scene.lights; i++) {
        let from_light = incident(i, in.position_mm);
        let mirrored = specular_direct(normal, to_eye, from_light.towards);
        if mirrored > 0.0 {
            radiance += from_light.irradiance * mirrored * light_visibility(i, in, normal);
        }
    }
    return vec4<f32>(display_value(radiance * scene.exposure), 1.0);
}
