// Needs: fresnel, object, scene, mapping, patch_layers, visibilities, vertex_none, vertex.
// G-buffer of a mesh for splats: positions, texture coordinates on the patch, albedo.

struct GBuffer {
    // Position relative to the middle of the scene, and depth, in mm.
    @location(0) position: vec4<f32>,
    // Texture coordinates of both places in copies of the patch, 0 to 2; -1 where there is no second place.
    @location(1) uv: vec4<f32>,
    // Albedo under uniform light; linear Rec. 709. Share of the first place in the fourth channel.
    @location(2) albedo: vec4<f32>,
}

@fragment
fn surface_gbuffer(in: Varying) -> GBuffer {
    let at = lookup_of(in);
    let second = select(within_two(at.places.second), vec2<f32>(-1.0), at.places.sides.share == 1.0);
    return GBuffer(
        vec4<f32>(in.position_mm - scene.centre_mm, depth_of(in.position_mm)),
        vec4<f32>(within_two(at.places.first), second),
        vec4<f32>(layer_at(0u, at), at.places.sides.share),
    );
}
