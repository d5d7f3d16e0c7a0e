// What a light sees: where its light enters, and how much.

@group(1) @binding(0) var<uniform> which: Which;

struct FromLight {
    @builtin(position) clip: vec4<f32>,
    @location(0) position_mm: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
}

@vertex
fn project(
    @location(0) position_mm: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
) -> FromLight {
    let clip = scene.light[min(which.light, 3u)].clip_from_world * vec4<f32>(position_mm, 1.0);
    return FromLight(clip, position_mm, normal, uv);
}

@fragment
fn see(in: FromLight) -> Seen {
    let normal = normalize(in.normal);
    let from_light = incident(which.light, in.position_mm);
    let cosine = dot(normal, from_light.towards);
    // Flux through a texel: what enters a piece of surface that is 1 / cos as large as the texel.
    let across = -dot(from_light.towards, scene.light[min(which.light, 3u)].axis);
    let entered = select(0.0, fresnel_transmittance(clamp(cosine, 0.0, 1.0), scene.eta) * across, cosine > 0.0);
    let depth = light_depth(which.light, in.position_mm);
    let place = fract(place_of(in.position_mm, normal, in.uv) * 0.5) * 2.0;
    return Seen(
        kept(vec4<f32>(in.position_mm - scene.centre_mm, depth)),
        kept(vec4<f32>(min(from_light.irradiance * entered, BRIGHTEST), 1.0)),
        kept(vec4<f32>(place, depth, depth)),
    );
}
