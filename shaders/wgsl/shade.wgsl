// The picture of a mesh: radiance that leaves towards the eye, tone-mapped.

struct Camera {
    clip_from_world: mat4x4<f32>,
    // Position in mm.
    eye_mm: vec3<f32>,
    // Multiplies radiance before tone mapping.
    exposure: f32,
    // 1 / (1 - F_dr from outside): F_t averages to 1 over the cosine-weighted hemisphere.
    exit_scale: f32,
    // Refractive index.
    eta: f32,
    // Texels to a row of the exitance texture.
    row: u32,
    pad_0: u32,
    // Radiance from all around, which the surface reflects.
    sky: vec3<f32>,
    pad_1: u32,
}

@group(0) @binding(0) var<uniform> camera: Camera;
// Exitance of every vertex.
@group(0) @binding(1) var exitances: texture_2d<f32>;

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) position_mm: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) exitance: vec3<f32>,
}

@vertex
fn project(
    @location(0) position_mm: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) point: u32,
) -> Varying {
    let texel = vec2<u32>(point % camera.row, point / camera.row);
    let exitance = textureLoad(exitances, texel, 0).xyz;
    return Varying(camera.clip_from_world * vec4<f32>(position_mm, 1.0), position_mm, normal, exitance);
}

@fragment
fn shade(in: Varying) -> @location(0) vec4<f32> {
    // What scattered, by Lambert's law with Fresnel transmission on the way out, normalised, and what is reflected:
    // L = M F_t / (pi (1 - F_dr)) + (1 - F_t) L_sky.
    let to_eye = normalize(camera.eye_mm - in.position_mm);
    let cosine = clamp(abs(dot(normalize(in.normal), to_eye)), 0.0, 1.0);
    let transmittance = fresnel_transmittance(cosine, camera.eta);
    let scattered = in.exitance * transmittance * camera.exit_scale / 3.14159265;
    let radiance = scattered + (1.0 - transmittance) * camera.sky;
    return vec4<f32>(srgb(neutral(radiance * camera.exposure)), 1.0);
}
