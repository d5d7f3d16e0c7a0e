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

/// Reflectance of a rough coat whose smooth one would be `at_angle`, 0 to 1: roughness flattens its rise towards grazing angles
/// (after Karis 2014, "Physically based shading on mobile").
fn rough_reflectance(object: &Object, at_angle: f32) -> f32 {
    let facing = 1.0 - fresnel_transmittance(1.0, object.eta);
    facing + (at_angle - facing) * (1.0 - object.roughness) * (1.0 - 0.5 * object.roughness)
}

/// Reflectance of the coat under the environment, 0 to 1.
#[must_use]
pub fn specular_ambient(object: &Object, cosine: f32) -> f32 {
    rough_reflectance(object, 1.0 - fresnel_transmittance(cosine, object.eta))
}

/// Share of Lambert's law that the coat lets out where its reflectance is R: (1 − R) / (1 − R_dr). R_dr is the mean of R, weighted by
/// the cosine: F_dr of the smooth coat, flattened as R is. So the mean of this, weighted by the cosine, is 1.
pub(super) fn leaving(object: &Object, reflectance: f32) -> f32 {
    (1.0 - reflectance) / (1.0 - rough_reflectance(object, 1.0 - object.sky_transmittance))
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;
    use crate::cpu::diffuse_transmittance;

    fn coat(eta: f32, roughness: f32) -> Object {
        Object { eta, roughness, sky_transmittance: diffuse_transmittance(eta), ..Object::zeroed() }
    }

    /// What leaves is what is not reflected, in every direction, but for a factor that makes its mean 1.
    #[test]
    fn leaving_light_is_what_the_coat_does_not_reflect() {
        for (eta, roughness) in [(1.0, 0.0), (1.3, 0.25), (1.5, 0.0), (1.5, 0.25), (1.5, 1.0), (2.0, 0.5)] {
            let object = coat(eta, roughness);
            let cosines: Vec<f32> = (0_i16..10_000).map(|k| (f32::from(k) + 0.5) / 1e4).collect();
            let mean =
                |f: &dyn Fn(f32) -> f32| cosines.iter().map(|&cosine| 2.0 * f(cosine) * cosine).sum::<f32>() / 1e4;
            let reflected = |cosine| specular_ambient(&object, cosine);
            let let_through = 1.0 - mean(&reflected);
            assert!(
                (mean(&|cosine| leaving(&object, reflected(cosine))) - 1.0).abs() < 1e-3,
                "mean, η {eta}, roughness {roughness}"
            );
            for cosine in [0.0, 0.1, 0.5, 1.0] {
                let all = leaving(&object, reflected(cosine)) * let_through + reflected(cosine);
                assert!((all - 1.0).abs() < 1e-3, "η {eta}, roughness {roughness}, cosine {cosine}: {all}");
            }
        }
        let along_the_surface = |object: Object| leaving(&object, specular_ambient(&object, 0.0));
        assert!(along_the_surface(coat(1.5, 0.0)) < 1e-2, "a smooth coat is a mirror there");
        assert!(along_the_surface(coat(1.5, 0.25)) > 0.3, "a rough one is not");
    }
}
