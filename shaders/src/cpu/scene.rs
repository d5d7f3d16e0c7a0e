//! Twin of `scene.wgsl`.

use glam::Vec3;

use super::fresnel_transmittance;
use crate::rgb::Rgb;
use crate::uniform::{Blocks, Object, Scene};

/// Light of one source at a point: unit vector towards it, and irradiance on a plane that faces it.
#[must_use]
pub fn incident(scene: &Scene, light: usize, position_mm: Vec3) -> (Vec3, Vec3) {
    let source = &scene.light[light];
    let (place, irradiance) = (Vec3::from(source.position_or_direction), Vec3::from(source.irradiance));
    if source.is_local == 0 {
        return (place, irradiance);
    }
    let to_light = place - position_mm;
    let distance2 = to_light.length_squared().max(1e-6);
    let towards = to_light / distance2.sqrt();
    // Full inside the inner cone, none outside the outer one.
    let along = -towards.dot(source.axis.into());
    let part = ((along - source.cos_outer) / (source.cos_inner - source.cos_outer)).clamp(0.0, 1.0);
    (towards, irradiance * (part * part * (3.0 - 2.0 * part)) / distance2)
}

/// Share of an incident light's irradiance that enters: F_t(cos) max(cos, 0).
#[must_use]
pub fn entering(object: &Object, normal: Vec3, towards: Vec3) -> f32 {
    let cosine = normal.dot(towards).clamp(0.0, 1.0);
    fresnel_transmittance(cosine, object.eta) * cosine
}

/// Irradiance of the environment that enters (Ramamoorthi and Hanrahan 2001, eq. 13).
#[must_use]
pub fn sky_irradiance(blocks: &Blocks, n: Vec3) -> Rgb {
    let basis = [1.0, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3.0 * n.z * n.z - 1.0, n.x * n.z, n.x * n.x - n.y * n.y];
    [0, 1, 2].map(|c| {
        let sum: f32 = basis.iter().zip(&blocks.scene.sky).map(|(value, coefficients)| value * coefficients[c]).sum();
        sum.max(0.0) * blocks.object.sky_transmittance
    })
}
