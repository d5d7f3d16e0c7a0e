// Needs: <target format>, fresnel, object, scene, host_shadow, tsm_visibility, visibilities, vertex_none, vertex, spread, kernel_profile, kernel_transmission.
// G-buffer for separable kernels on the screen: light that enters, and light that is transmitted from behind; depth in mm in the fourth
// channel.

struct EnteredAndTransmitted {
    @location(0) entered: TargetTexel,
    @location(1) transmitted: TargetTexel,
}

@fragment
fn kernel_gbuffer(in: Varying) -> EnteredAndTransmitted {
    let normal = normalize(in.normal);
    let depth = depth_of(in.position_mm);
    var entered = vec3<f32>(0.0);
    var from_behind = vec3<f32>(0.0);
    for (var i = 0u; i < scene.lights; i++) {
        let from_light = incident(i, in.position_mm);
        let share = entering(normal, from_light.towards);
        // Surfaces that face the light have its light from the blurs.
        let facing_away = clamp(-dot(normal, from_light.towards), 0.0, 1.0);
        if share > 0.0 {
            entered += from_light.irradiance * share * visibility(i, in.position_mm, normal);
        }
        if facing_away > 0.0 {
            from_behind += facing_away * transmitted(i, in.position_mm, facing_away);
        }
    }
    return EnteredAndTransmitted(
        pack(vec4<f32>(min(entered, BRIGHTEST), depth)),
        pack(vec4<f32>(min(from_behind, BRIGHTEST), depth)),
    );
}
