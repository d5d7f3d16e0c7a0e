// What the eye sees of a mesh: positions, places on the patch, albedo.

struct Visible {
    // Relative to the middle of the scene, and depth, in mm.
    @location(0) position: vec4<f32>,
    // Copies of the patch.
    @location(1) place: vec4<f32>,
    // Under uniform light; linear rgb.
    @location(2) albedo: vec4<f32>,
}

@fragment
fn view(in: Varying) -> Visible {
    let change = step_of(in.position_mm, in.uv);
    let normal = normalize(in.normal);
    // Mirrored patches repeat after two; half floats are finest there.
    let place = fract(place_of(in.position_mm, normal, in.uv) * 0.5) * 2.0;
    return Visible(
        vec4<f32>(in.position_mm - scene.centre_mm, depth_of(in.position_mm)),
        vec4<f32>(place, 0.0, 0.0),
        vec4<f32>(layer_at(0u, in.position_mm, normal, in.uv, change), 1.0),
    );
}
