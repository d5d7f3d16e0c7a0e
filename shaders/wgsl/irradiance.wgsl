// Irradiance that enters a surface at each of its points: E = F_t(cos) max(cos, 0) V E_light + T_sky E_sky.

struct Light {
    // Unit vector towards the light.
    direction: vec3<f32>,
    pad_0: f32,
    // Irradiance on a plane that faces the light.
    irradiance: vec3<f32>,
    pad_1: f32,
    // Irradiance from all around.
    sky: vec3<f32>,
    // 1 - F_dr from outside: what of the sky's light enters.
    sky_transmittance: f32,
    // Refractive index of the material against air.
    eta: f32,
    pad_2: f32,
    pad_3: f32,
    pad_4: f32,
}

@group(0) @binding(0) var<uniform> light: Light;
// Unit normal, and how much of the light reaches the point, 0 to 1.
@group(0) @binding(1) var normals: texture_2d<f32>;

@fragment
fn irradiance(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let normal = textureLoad(normals, vec2<u32>(at.xy), 0);
    let cosine = max(dot(normal.xyz, light.direction), 0.0);
    let entering = fresnel_transmittance(cosine, light.eta) * cosine * normal.w;
    return vec4<f32>(entering * light.irradiance + light.sky_transmittance * light.sky, 1.0);
}
