//! Light on a relief: from a direction, and from texel to texel.

use glam::Vec3;

use super::height_field::{DIRECTIONS, Exchange, Relief, SKY};
use super::reflectance::Shading;

/// Irradiance of all texels under one light.
pub(super) struct LightOn {
    /// Unit vector towards the light.
    pub(super) towards: Vec3,
    /// Irradiance that comes straight from the light: its cosine where it is seen.
    pub(super) direct: Vec<f32>,
    /// Irradiance that comes from other texels.
    pub(super) indirect: Vec<Vec3>,
}

/// Times that light goes from texel to texel.
const BOUNCES: usize = 2;

impl LightOn {
    pub(super) fn new(relief: &Relief, exchange: &Exchange, towards: Vec3) -> Self {
        let texels = 0..relief.len();
        #[allow(clippy::cast_possible_truncation, reason = "images are below 65,536 pixels wide")]
        let normal = |texel: usize| relief.normal(texel as u32);
        let cosine = |texel| if relief.is_lit(texel, towards) { normal(texel).dot(towards) } else { 0.0 };
        let direct: Vec<f32> = texels.clone().map(cosine).collect();
        let mut indirect = vec![Vec3::ZERO; relief.len()];
        for _ in 0..BOUNCES {
            // E = mean of ρ (E_direct + E_indirect) over cosine-distributed directions; the sky is black.
            let gathered = |texel: usize| {
                let others = exchange[texel].iter().filter(|other| **other != SKY);
                let exitances = others.map(|&other| {
                    let lit = Vec3::splat(direct[other as usize]) + indirect[other as usize];
                    relief.finish(other).diffuse * lit
                });
                exitances.sum::<Vec3>() / DIRECTIONS as f32
            };
            indirect = texels.clone().map(gathered).collect();
        }
        Self { towards, direct, indirect }
    }

    /// π times the radiance that leaves a texel towards the eye, linear Rec. 709.
    pub(super) fn radiance(&self, relief: &Relief, texel: u32, towards_eye: Vec3) -> Vec3 {
        let finish = relief.finish(texel);
        let shading = Shading { normal: relief.normal(texel), light: self.towards, eye: towards_eye };
        let direct = finish.reflect(&shading) * (std::f32::consts::PI * self.direct[texel as usize]);
        direct + finish.diffuse * self.indirect[texel as usize]
    }
}
