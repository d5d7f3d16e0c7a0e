// Needs: <target format>, fresnel, object, scene, visibilities, fullscreen.
// Irradiance that enters a surface at each of its points: E = sum over lights of F_t(cos) max(cos, 0) V E_light + T_sky E_sky.

// Positions in mm of the mesh.
@group(1) @binding(0) var positions: texture_2d<f32>;
// Unit normals.
@group(1) @binding(1) var normals: texture_2d<f32>;
// Visibility of each light, packed.
@group(1) @binding(2) var visibilities: texture_2d<u32>;

@fragment
fn irradiance(@builtin(position) at: vec4<f32>) -> @location(0) TargetTexel {
    let texel = vec2<u32>(at.xy);
    let position = world_position(textureLoad(positions, texel, 0).xyz);
    let normal = normalize(world_direction(textureLoad(normals, texel, 0).xyz));
    let seen = unpack_visibilities(textureLoad(visibilities, texel, 0));
    var sum = sky_irradiance(normal);
    for (var i = 0u; i < scene.lights; i++) {
        let from_light = incident(i, position);
        sum += from_light.irradiance * entering(normal, from_light.towards) * visibility_of(i, seen);
    }
    return pack(vec4<f32>(sum, 1.0));
}
