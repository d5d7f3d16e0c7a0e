// Needs: fresnel, object, scene, mapping, patch_layers, visibilities, vertex_none, vertex.
// G-buffer of a mesh for splats: positions, texture coordinates on the patch, albedo.

struct GBuffer {
    // Position relative to the middle of the scene, and depth, in mm.
    @location(0) position: vec4<f32>,
    // Texture coordinates in copies of the patch, 0 to 2.
    @location(1) uv: vec4<f32>,
    // Albedo under uniform light; linear Rec. 709.
    @location(2) albedo: vec4<f32>,
}

@fragment
fn surface_gbuffer(in: Varying) -> GBuffer {
    let slopes = derivatives(in.position_mm, in.uv);
    let normal = normalize(in.normal);
    // Mirrored patches repeat after two; half floats are finest there.
    let uv = fract(patch_uv(in.position_mm, normal, in.uv) * 0.5) * 2.0;
    return GBuffer(
        vec4<f32>(in.position_mm - scene.centre_mm, depth_of(in.position_mm)),
        vec4<f32>(uv, 0.0, 0.0),
        vec4<f32>(layer_at(0u, in.position_mm, normal, in.uv, slopes), 1.0),
    );
}
