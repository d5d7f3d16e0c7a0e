// Needs: <target format>, fresnel, object, scene, mapping, tsm.
// Translucent shadow map of a light: where its light enters the mesh, and how much.

@group(1) @binding(0) var<uniform> tsm_light: TsmLight;

struct LightVarying {
    @builtin(position) clip: vec4<f32>,
    @location(0) position_mm: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Signed shares of the sides of the box, for box mapping.
    @location(3) sides: vec3<f32>,
}

@vertex
fn project(
    @location(0) position_mm: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(7) sides: vec4<f32>,
) -> LightVarying {
    let position = world_position(position_mm);
    let clip = scene.light[min(tsm_light.light, MAX_LIGHTS - 1u)].clip_from_world * vec4<f32>(position, 1.0);
    return LightVarying(clip, position, world_direction(normal), material_uv(uv), sides.xyz);
}

// One of the places at a point, by chance: what is entered is a sum over many texels, in which they are blended. Steps by the
// generalised golden ratio in two dimensions spread the choices evenly (Roberts 2018).
fn one_of(places: Places, texel: vec2<f32>) -> vec2<f32> {
    let chance = fract(0.5 + dot(texel, vec2<f32>(0.75487766, 0.56984029)));
    return select(places.second, places.first, chance < places.sides.share);
}

@fragment
fn tsm_render(in: LightVarying) -> TsmTexel {
    let normal = normalize(in.normal);
    let from_light = incident(tsm_light.light, in.position_mm);
    let cosine = dot(normal, from_light.towards);
    // Flux through a texel: the light that enters a piece of surface 1 / cos as large as the texel.
    let across = -dot(from_light.towards, scene.light[min(tsm_light.light, MAX_LIGHTS - 1u)].axis);
    let entered = select(0.0, fresnel_transmittance(clamp(cosine, 0.0, 1.0), object.eta) * across, cosine > 0.0);
    let depth = light_depth(tsm_light.light, in.position_mm);
    // The same in every tile.
    let of_tile = vec2<u32>(in.clip.xy) % scene.light_texels;
    let uv = within_two(one_of(places_of(in.position_mm, in.sides, in.uv), vec2<f32>(of_tile)));
    return TsmTexel(
        pack(vec4<f32>(depth, in.position_mm - scene.centre_mm)),
        pack(vec4<f32>(min(from_light.irradiance * entered, BRIGHTEST), object.group)),
        pack(vec4<f32>(uv, depth, depth)),
    );
}
