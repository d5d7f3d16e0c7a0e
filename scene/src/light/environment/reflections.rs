//! What mirrors of several roughnesses see of an environment.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use glam::{Vec2, Vec3};

use super::picture::{Picture, size_of};

/// Number of levels of [`super::Environment::reflections`].
pub const REFLECTION_LEVELS: u32 = 6;

/// Width and height of the finest level of [`super::Environment::reflections`], in texels.
pub const REFLECTION_SIZE: [u32; 2] = [128, 64];

/// Number of directions in which a rough mirror looks, for each of its texels.
const DIRECTIONS: u16 = 512;

/// Levels of [`super::Environment::reflections`].
pub(super) fn reflect(picture: &Picture) -> Vec<Vec<[f32; 3]>> {
    // The picture in ever larger texels: a direction that stands for a large solid angle sees all that is in it.
    let mut sources = vec![picture.resized(REFLECTION_SIZE)];
    for level in 1..REFLECTION_LEVELS {
        sources.push(sources[level as usize - 1].resized(level_size(level)));
    }
    let level = |k: u32| match k {
        0 => sources[0].pixels.clone(),
        _ => blur(&sources, level_size(k), &lobe(k as f32 / (REFLECTION_LEVELS - 1) as f32)),
    };
    (0..REFLECTION_LEVELS).map(|k| level(k).iter().map(Vec3::to_array).collect()).collect()
}

/// Direction in which a rough mirror looks, z along the reflection of the eye.
struct Look {
    direction: Vec3,
    /// Solid angle that the direction stands for, in sr.
    solid_angle: f32,
}

/// Directions in which a mirror of GGX roughness looks whose normal is z, looked at along z; α = roughness². Karis 2013.
fn lobe(roughness: f32) -> Vec<Look> {
    let alpha_sq = roughness.powi(4);
    let look = |k: u16| {
        // Hammersley points ξ: cos² θ_h = (1 − ξ₁) / (1 + (α² − 1) ξ₁), φ = 2π ξ₂.
        let xi_1 = (f32::from(k) + 0.5) / f32::from(DIRECTIONS);
        let xi_2 = u32::from(k).reverse_bits() as f32 / 2.0_f32.powi(32);
        let cos_sq = (1.0 - xi_1) / (1.0 + (alpha_sq - 1.0) * xi_1);
        // L = 2 (N · H) H − N.
        let (sin_phi, cos_phi) = (TAU * xi_2).sin_cos();
        let across = 2.0 * (cos_sq * (1.0 - cos_sq)).max(0.0).sqrt();
        let direction = Vec3::new(across * cos_phi, across * sin_phi, 2.0 * cos_sq - 1.0);
        // pdf(L) = D (N · H) / 4 (V · H) = D / 4, D = α² / π ((α² − 1) cos² θ_h + 1)².
        let density = alpha_sq * FRAC_1_PI / ((alpha_sq - 1.0) * cos_sq + 1.0).powi(2);
        Look { direction, solid_angle: 4.0 / (density * f32::from(DIRECTIONS)) }
    };
    (0..DIRECTIONS).map(look).filter(|look| look.direction.z > 0.0).collect()
}

/// Mean radiance in the directions of `lobe`, weighted with N · L, for each texel of a picture of `size`.
fn blur(sources: &[Picture], size: [u32; 2], lobe: &[Look]) -> Vec<Vec3> {
    let weights: f32 = lobe.iter().map(|look| look.direction.z).sum();
    let texel = |x: u32, y: u32| {
        let uv = (Vec2::new(x as f32, y as f32) + 0.5) / size_of(size);
        let (sin_phi, cos_phi) = (TAU * (uv.x - 0.5)).sin_cos();
        let (sin_theta, cos_theta) = (PI * uv.y).sin_cos();
        let east = Vec3::new(cos_phi, 0.0, -sin_phi);
        let north = Vec3::new(-cos_theta * sin_phi, sin_theta, -cos_theta * cos_phi);
        let normal = Vec3::new(sin_theta * sin_phi, cos_theta, sin_theta * cos_phi);
        let radiance = |look: &Look| {
            let [x, y, z] = look.direction.to_array();
            let direction = east * x + north * y + normal * z;
            z * sources[source_of(direction, look.solid_angle)].radiance(direction)
        };
        lobe.iter().map(radiance).sum::<Vec3>() / weights
    };
    (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y])).map(|[x, y]| texel(x, y)).collect()
}

/// Number of the finest source whose texels in that direction are not smaller than a solid angle in sr, which grows fourfold.
fn source_of(direction: Vec3, solid_angle: f32) -> usize {
    let sin_theta = (1.0 - direction.y * direction.y).max(0.0).sqrt();
    let [width, height] = size_of(REFLECTION_SIZE).to_array();
    let texel = (TAU / width) * (PI / height) * sin_theta.max(PI / height);
    let level = (0.5 * (solid_angle / texel).log2()).ceil().clamp(0.0, (REFLECTION_LEVELS - 1) as f32);
    #[allow(clippy::cast_possible_truncation, reason = "clamped to the levels")]
    let level = level as usize;
    level
}

/// Width and height of a level in texels.
pub(super) fn level_size(level: u32) -> [u32; 2] {
    REFLECTION_SIZE.map(|side| side >> level)
}
