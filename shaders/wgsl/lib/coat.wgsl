// Specular reflection of the dielectric coat over the scattering material, from lights and from the environment.

// Environment prefiltered by GGX of rising roughness, equirectangular, a mipmap level each; linear Rec. 709.
@group(0) @binding(2) var reflections: texture_2d<f32>;
@group(0) @binding(3) var reflection_sampler: sampler;

const PI: f32 = 3.14159265;
// Mipmap level of roughness 1.
const ROUGHEST: f32 = 5.0;

// Radiance of the environment from a unit direction, as a mirror of that GGX roughness, 0 to 1, shows it.
fn sky_radiance(direction: vec3<f32>, roughness: f32) -> vec3<f32> {
    let around = 0.5 + atan2(direction.x, direction.z) / (2.0 * PI);
    let down = acos(clamp(direction.y, -1.0, 1.0)) / PI;
    return textureSampleLevel(reflections, reflection_sampler, vec2<f32>(around, down), roughness * ROUGHEST).xyz;
}

// Specular BRDF of microfacets times cosine for one light, in sr^-1: D V F (Walter et al. 2007, eq. 33; Heitz 2014, eq. 99),
// alpha = roughness^2.
fn specular_direct(normal: vec3<f32>, to_eye: vec3<f32>, towards: vec3<f32>) -> f32 {
    let nl = dot(normal, towards);
    let nv = max(dot(normal, to_eye), 1e-3);
    if nl <= 0.0 {
        return 0.0;
    }
    let h = normalize(to_eye + towards);
    let nh = clamp(dot(normal, h), 0.0, 1.0);
    // A mirror of no roughness would show a light as a point: never less than a light of its own size does.
    let alpha = max(object.roughness * object.roughness, 2e-3);
    let a2 = alpha * alpha;
    let d = nh * nh * (a2 - 1.0) + 1.0;
    let shadowing = nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2);
    let reflected = 1.0 - fresnel_transmittance(clamp(dot(h, to_eye), 0.0, 1.0), object.eta);
    return a2 / (PI * d * d) * 0.5 / shadowing * reflected * nl;
}

// Reflectance of a rough coat whose smooth one would be `at_angle`, 0 to 1: roughness flattens its rise towards grazing angles
// (after Karis 2014, "Physically based shading on mobile").
fn rough_reflectance(at_angle: f32) -> f32 {
    let facing = 1.0 - fresnel_transmittance(1.0, object.eta);
    return facing + (at_angle - facing) * (1.0 - object.roughness) * (1.0 - 0.5 * object.roughness);
}

// Reflectance of the coat under the environment, 0 to 1.
fn specular_ambient(cosine: f32) -> f32 {
    return rough_reflectance(1.0 - fresnel_transmittance(cosine, object.eta));
}

// Share of Lambert's law that the coat lets out where its reflectance is R: (1 - R) / (1 - R_dr). R_dr is the mean of R, weighted by
// the cosine: F_dr of the smooth coat, flattened as R is. So the mean of this, weighted by the cosine, is 1.
fn leaving(reflectance: f32) -> f32 {
    return (1.0 - reflectance) / (1.0 - rough_reflectance(1.0 - object.sky_transmittance));
}
