//! Twin of `coat.wgsl`.

use std::f32::consts::PI;

use glam::Vec3;

use super::fresnel_transmittance;
use crate::rgb::Rgb;
use crate::uniform::Object;

/// Environment prefiltered by GGX of rising roughness: equirectangular pictures, each half as large as the one before.
#[derive(Clone, Copy, Debug)]
pub struct Reflections<'a> {
    /// Texels of the first level, columns and rows.
    pub size: [u32; 2],
    /// Radiance of every level, linear Rec. 709, row by row.
    pub levels: &'a [Vec<Rgb>],
}

impl Reflections<'_> {
    /// Radiance from a direction as a rough mirror shows it, linear between texels and levels.
    #[must_use]
    pub fn radiance(&self, direction: Vec3, roughness: f32) -> Vec3 {
        let around = 0.5 + direction.x.atan2(direction.z) / (2.0 * PI);
        let down = direction.y.clamp(-1.0, 1.0).acos() / PI;
        #[allow(clippy::cast_precision_loss, reason = "a handful")]
        let level = roughness * (self.levels.len() - 1) as f32;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a handful, not negative")]
        let lower = (level as usize).min(self.levels.len() - 1);
        let upper = (lower + 1).min(self.levels.len() - 1);
        #[allow(clippy::cast_precision_loss, reason = "a handful")]
        let part = level - lower as f32;
        self.sample(lower, around, down).lerp(self.sample(upper, around, down), part)
    }

    /// Bilinear sample of a level, repeated around, clamped beyond the poles.
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "a hundred texels")]
    fn sample(&self, level: usize, around: f32, down: f32) -> Vec3 {
        let [width, height] = self.size.map(|side| (side >> level).max(1).cast_signed());
        let (x, y) = (around * width as f32 - 0.5, down * height as f32 - 0.5);
        let (column, row) = (x.floor() as i32, y.floor() as i32);
        let texel = |x: i32, y: i32| {
            let at = y.clamp(0, height - 1) * width + x.rem_euclid(width);
            Vec3::from(self.levels[level][at.cast_unsigned() as usize])
        };
        let (px, py) = (x - x.floor(), y - y.floor());
        let line = |y: i32| texel(column, y).lerp(texel(column + 1, y), px);
        line(row).lerp(line(row + 1), py)
    }
}

/// Specular BRDF of microfacets times cosine for one light, in sr⁻¹: D V F (Walter et al. 2007, eq. 33; Heitz 2014, eq. 99), α = roughness².
#[must_use]
pub fn specular_direct(object: &Object, normal: Vec3, to_eye: Vec3, towards: Vec3) -> f32 {
    let nl = normal.dot(towards);
    let nv = normal.dot(to_eye).max(1e-3);
    if nl <= 0.0 {
        return 0.0;
    }
    let h = (to_eye + towards).normalize();
    let nh = normal.dot(h).clamp(0.0, 1.0);
    // A mirror of no roughness would show a light as a point: never less than a light of its own size does.
    let alpha = (object.roughness * object.roughness).max(2e-3);
    let a2 = alpha * alpha;
    let d = nh * nh * (a2 - 1.0) + 1.0;
    let shadowing = nl * (nv * nv * (1.0 - a2) + a2).sqrt() + nv * (nl * nl * (1.0 - a2) + a2).sqrt();
    let reflected = 1.0 - fresnel_transmittance(h.dot(to_eye).clamp(0.0, 1.0), object.eta);
    a2 / (PI * d * d) * 0.5 / shadowing * reflected * nl
}

/// Reflectance of a rough coat under the environment, 0 to 1: Fresnel reflectance, which roughness flattens at grazing angles
/// (after Karis 2014, "Physically based shading on mobile").
#[must_use]
pub fn specular_ambient(object: &Object, cosine: f32) -> f32 {
    let facing = 1.0 - fresnel_transmittance(1.0, object.eta);
    let at_angle = 1.0 - fresnel_transmittance(cosine, object.eta);
    facing + (at_angle - facing) * (1.0 - object.roughness) * (1.0 - 0.5 * object.roughness)
}
