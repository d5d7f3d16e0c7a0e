//! Twin of `irradiance.wgsl`.

use glam::{Vec3, Vec4};

use super::{Rgb, fresnel_transmittance};
use crate::uniform::Light;

/// Irradiance that enters at each point, from its unit normal and, in the fourth place, how much of the light reaches
/// it: E = F_t(cos) max(cos, 0) V E_light + T_sky E_sky.
#[must_use]
pub fn irradiance(normals: &[Vec4], light: &Light) -> Vec<Rgb> {
    let at = |normal: &Vec4| {
        let cosine = normal.truncate().dot(Vec3::from(light.direction)).max(0.0);
        let entering = fresnel_transmittance(cosine, light.eta) * cosine * normal.w;
        [0, 1, 2].map(|c| entering * light.irradiance[c] + light.sky_transmittance * light.sky[c])
    };
    normals.iter().map(at).collect()
}
