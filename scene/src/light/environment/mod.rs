//! Light from far away, all around, as matt surfaces and as mirrors of any roughness see it.

mod irradiance;
mod picture;
mod reflections;
mod room;

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use crate::error::{Error, Result};
use irradiance::project;
use picture::Picture;
use reflections::{level_size, reflect};
use room::{Room, STAGE, STUDIO};

pub use reflections::{REFLECTION_LEVELS, REFLECTION_SIZE};

/// Light from all around, far away: irradiance by the normal, and radiance in mirrors by direction and roughness.
///
/// Pictures of it are in equirectangular projection: a direction (x, y, z), y up, is seen at
/// u = ½ + atan2(x, z) / 2π from the left and v = acos(y) / π from the top.
#[derive(Clone, Debug)]
pub struct Environment {
    irradiance: [[f32; 3]; 9],
    reflections: Vec<Vec<[f32; 3]>>,
}

impl Environment {
    /// Largest radiance of a picture: sums of it stay finite.
    pub const BRIGHTEST: f32 = 1e30;

    /// Environment of the same radiance from everywhere, `irradiance` / π; any surface gets `irradiance`, linear Rec. 709.
    #[must_use]
    pub fn uniform(irradiance: [f32; 3]) -> Self {
        let mut coefficients = [[0.0; 3]; 9];
        coefficients[0] = irradiance;
        let radiance = irradiance.map(|channel| channel * FRAC_1_PI);
        let level = |k| vec![radiance; level_size(k).map(|side| side as usize).iter().product()];
        Self { irradiance: coefficients, reflections: (0..REFLECTION_LEVELS).map(level).collect() }
    }

    /// Photographer's studio without its key light: a large softbox overhead, a strip on the left, a dim floor. It has
    /// something to reflect and needs no file.
    ///
    /// # Panics
    /// Never: its radiances are finite.
    #[must_use]
    pub fn studio() -> Self {
        Self::built_in(&STUDIO)
    }

    /// Dark stage around one bright light: a cool, faint box overhead behind what is seen, a strip on the left, night around.
    ///
    /// # Panics
    /// Never: its radiances are finite.
    #[must_use]
    pub fn stage() -> Self {
        Self::built_in(&STAGE)
    }

    /// Environment of a room.
    fn built_in(room: &Room) -> Self {
        const SIZE: [u32; 2] = [128, 64];
        let radiance = |x: u32, y: u32| {
            #[allow(clippy::cast_precision_loss, reason = "a hundred")]
            let (u, v) = ((x as f32 + 0.5) / SIZE[0] as f32, (y as f32 + 0.5) / SIZE[1] as f32);
            let (around, down) = (std::f32::consts::TAU * (u - 0.5), std::f32::consts::PI * v);
            room.radiance(Vec3::new(down.sin() * around.sin(), down.cos(), down.sin() * around.cos())).into()
        };
        let pixels: Vec<_> =
            (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))).map(|(x, y)| radiance(x, y)).collect();
        Self::equirectangular(SIZE, &pixels).expect("built-in radiances are finite")
    }

    /// Environment from a picture of `size`, width and height, row by row from the top, each from the left.
    ///
    /// Pixels are radiance, linear Rec. 709, 0 to 10³⁰. Light of a pixel counts for the solid angle of the pixel.
    ///
    /// # Errors
    /// [`Error::Environment`] if the picture is empty, has not one pixel for each place, or a pixel is out of range.
    pub fn equirectangular(size: [u32; 2], pixels: &[[f32; 3]]) -> Result<Self> {
        let [width, height] = size;
        let wrong = |what: String| Err(Error::Environment(what));
        if pixels.is_empty() {
            return wrong("no pixels".to_owned());
        }
        if u64::from(width) * u64::from(height) != pixels.len() as u64 {
            return wrong(format!("{width} x {height} pixels, but {} are given", pixels.len()));
        }
        let in_range = |pixel: &[f32; 3]| pixel.iter().all(|channel| (0.0..=Self::BRIGHTEST).contains(channel));
        if let Some(at) = pixels.iter().position(|pixel| !in_range(pixel)) {
            let (x, y) = (at % width as usize, at / width as usize);
            return wrong(format!("pixel ({x}, {y}) is {:?}, not between 0 and {:e}", pixels[at], Self::BRIGHTEST));
        }
        let picture = Picture { size, pixels: pixels.iter().copied().map(Vec3::from).collect() };
        Ok(Self { irradiance: project(&picture), reflections: reflect(&picture) })
    }

    /// Coefficients c of the irradiance on a surface of unit normal (x, y, z), linear Rec. 709:
    ///
    /// E = c₀ + c₁ y + c₂ z + c₃ x + c₄ xy + c₅ yz + c₆ (3z² − 1) + c₇ xz + c₈ (x² − y²).
    ///
    /// The cosine lobe and the constants of the real spherical harmonics are in the coefficients. Approximate: higher
    /// orders are left out, which for a single small light is at most 0.1 of the irradiance that faces it, and may lead
    /// a little below zero. Ramamoorthi and Hanrahan 2001, eq. 10 to 13.
    #[must_use]
    pub fn irradiance_coefficients(&self) -> &[[f32; 3]; 9] {
        &self.irradiance
    }

    /// Irradiance on a surface of unit `normal`, linear Rec. 709, at least 0.
    #[must_use]
    pub fn irradiance(&self, normal: Vec3) -> [f32; 3] {
        let [x, y, z] = normal.to_array();
        let terms = [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y];
        let sum: Vec3 = self.irradiance.iter().zip(terms).map(|(c, term)| Vec3::from(*c) * term).sum();
        sum.max(Vec3::ZERO).to_array()
    }

    /// Radiance in mirrors of GGX roughness k / ([`REFLECTION_LEVELS`] − 1), by the direction of the reflection.
    ///
    /// Shape `[k][row][column][rgb]`, linear Rec. 709, equirectangular; level k has [`REFLECTION_SIZE`] / 2ᵏ texels.
    /// Level 0 is the picture itself. Approximate: as if looked at from the direction of the reflection.
    /// Karis 2013, "Real Shading in Unreal Engine 4".
    #[must_use]
    pub fn reflections(&self) -> &[Vec<[f32; 3]>] {
        &self.reflections
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::{PI, TAU};

    use glam::Vec2;

    use super::*;

    fn direction([width, height]: [u32; 2], x: u32, y: u32) -> Vec3 {
        let uv = (Vec2::new(x as f32, y as f32) + 0.5) / Vec2::new(width as f32, height as f32);
        let (phi, theta) = (TAU * (uv.x - 0.5), PI * uv.y);
        Vec3::new(theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos())
    }

    fn picture(size: [u32; 2], radiance: impl Fn(Vec3) -> [f32; 3]) -> Environment {
        let pixels: Vec<[f32; 3]> =
            (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| direction(size, x, y))).map(radiance).collect();
        Environment::equirectangular(size, &pixels).unwrap()
    }

    /// Solid angle of one texel of a row, in sr.
    fn texel_sr([width, height]: [u32; 2], row: u32) -> f32 {
        let [top, bottom] = [row, row + 1].map(|edge| (PI * edge as f32 / height as f32).cos());
        TAU / width as f32 * (top - bottom)
    }

    fn mean(environment: &Environment, level: u32) -> Vec3 {
        let size = level_size(level);
        let rows = environment.reflections()[level as usize].chunks_exact(size[0] as usize);
        let light =
            |(y, row): (u32, &[[f32; 3]])| row.iter().copied().map(Vec3::from).sum::<Vec3>() * texel_sr(size, y);
        (0..).zip(rows).map(light).sum::<Vec3>() / (2.0 * TAU)
    }

    fn near(a: impl Into<Vec3>, b: impl Into<Vec3>, tolerance: f32, what: &str) {
        let (a, b): (Vec3, Vec3) = (a.into(), b.into());
        assert!(a.abs_diff_eq(b, tolerance), "{what}: {a} is not {b}");
    }

    #[test]
    fn uniform_light_is_the_same_on_every_side_and_at_every_roughness() {
        let irradiance = Vec3::new(3.0, 2.0, 0.5);
        let radiance = irradiance / PI;
        // A picture of one pixel, and one of sides that do not divide those of the levels.
        let constant = |size| picture(size, |_| radiance.to_array());
        for environment in [Environment::uniform(irradiance.into()), constant([1, 1]), constant([301, 77])] {
            for y in 0..8 {
                let normal = direction([16, 8], 5 * y % 16, y);
                near(environment.irradiance(normal), irradiance, 1e-4, "irradiance");
            }
            assert_eq!(environment.reflections().len(), REFLECTION_LEVELS as usize);
            for (k, level) in (0..).zip(environment.reflections()) {
                let [width, height] = level_size(k);
                assert_eq!(level.len(), (width * height) as usize, "level {k}");
                level.iter().for_each(|texel| near(*texel, radiance, 1e-4, "radiance"));
            }
        }
    }

    #[test]
    fn a_small_sun_shines_by_the_cosine() {
        let sun = Vec3::new(0.6, 0.5, -0.3).normalize();
        // Within 3° of the sun: 2π (1 − cos 3°) sr.
        let cos_sun = 3.0_f32.to_radians().cos();
        let radiance = 1.0 / (TAU * (1.0 - cos_sun));
        let environment = picture([1024, 512], |at| [if at.dot(sun) > cos_sun { radiance } else { 0.0 }; 3]);
        for y in 0..32 {
            for x in 0..64 {
                let normal = direction([64, 32], x, y);
                let cos = normal.dot(sun);
                let [irradiance, ..] = environment.irradiance(normal);
                // The first three terms of the cosine lobe: 1/4 + cos/2 + 5/16 P₂(cos).
                let terms = 0.25 + 0.5 * cos + 0.15625 * (3.0 * cos * cos - 1.0);
                assert!((irradiance - terms.max(0.0)).abs() < 0.01, "{irradiance} at a cosine of {cos}");
                assert!((irradiance - cos.max(0.0)).abs() < 0.1, "{irradiance} at a cosine of {cos}");
            }
        }
    }

    #[test]
    fn coefficients_are_those_of_the_light_that_makes_them() {
        // Under the light 1 + d · n, E = π + 2π/3 d · n; d has no part in the quadratic terms.
        let d = Vec3::new(0.2, -0.5, 0.4);
        let linear = picture([256, 128], |at| [1.0 + at.dot(d); 3]);
        let quadratic = picture([256, 128], |at| [1.0 + at.x * at.z; 3]);
        for y in 0..8 {
            let n = direction([16, 8], 7 * y % 16, y);
            near(linear.irradiance(n), Vec3::splat(PI + TAU / 3.0 * d.dot(n)), 1e-3, "linear");
            near(quadratic.irradiance(n), Vec3::splat(PI + PI / 4.0 * n.x * n.z), 1e-3, "quadratic");
        }
    }

    #[test]
    fn rough_mirrors_neither_make_nor_lose_light() {
        let sky = picture([512, 256], |at| {
            let ground = Vec3::new(0.3, 0.2, 0.1);
            let sky = ground.lerp(Vec3::new(0.5, 0.8, 1.5), 0.5 + 0.5 * (4.0 * at.y).tanh());
            (sky + (8.0 * (at.dot(Vec3::new(0.48, 0.6, 0.64)) - 1.0)).exp()).to_array()
        });
        let all = mean(&sky, 0);
        for level in 1..REFLECTION_LEVELS {
            let ratio = mean(&sky, level) / all;
            assert!((ratio - 1.0).abs().max_element() < 0.03, "level {level}: {ratio}");
        }
    }

    #[test]
    fn rough_mirrors_see_what_an_integral_over_all_directions_sees() {
        let sun = Vec3::new(0.5, 0.6, -0.4).normalize();
        let cos_sun = 4.0_f32.to_radians().cos();
        let environment = picture([512, 256], |at| [if at.dot(sun) > cos_sun { 500.0 } else { 1.0 }; 3]);
        for level in 1..REFLECTION_LEVELS {
            let alpha_sq = (level as f32 / 5.0).powi(4);
            let size = level_size(level);
            let mut brightest = 0.0_f32;
            let mut worst = 0.0_f32;
            for (at, seen) in (0..).zip(&environment.reflections()[level as usize]) {
                let normal = direction(size, at % size[0], at / size[0]);
                // ∫ L D (N · L) dω / ∫ D (N · L) dω.
                let (mut light, mut weights) = (0.0, 0.0);
                for (source, radiance) in (0..).zip(&environment.reflections()[0]) {
                    let [width, _] = REFLECTION_SIZE;
                    let cos = normal.dot(direction(REFLECTION_SIZE, source % width, source / width));
                    let cos_h_sq = 0.5 + 0.5 * cos;
                    let density = ((alpha_sq - 1.0) * cos_h_sq + 1.0).powi(-2);
                    let weight = cos.max(0.0) * density * texel_sr(REFLECTION_SIZE, source / width);
                    light += radiance[0] * weight;
                    weights += weight;
                }
                brightest = brightest.max(light / weights);
                worst = worst.max((light / weights - seen[0]).abs());
            }
            assert!(worst < 0.1 * brightest, "level {level}: off by {worst} where the brightest is {brightest}");
        }
    }

    #[test]
    fn pictures_of_no_sense_are_refused() {
        let refused = |size, pixels: &[[f32; 3]]| Environment::equirectangular(size, pixels).unwrap_err().to_string();
        assert!(refused([0, 0], &[]).contains("no pixels"), "nothing");
        assert!(refused([0, 2], &[[1.0; 3]]).contains("0 x 2"), "no columns");
        assert!(refused([2, 2], &[[1.0; 3]; 3]).contains("2 x 2 pixels, but 3"), "too few");
        assert!(refused([u32::MAX; 2], &[[1.0; 3]]).contains("but 1"), "more than there is memory");
        for bad in [f32::NAN, f32::INFINITY, -1e-3, 1e31] {
            let mut pixels = [[1.0; 3]; 6];
            pixels[4][1] = bad;
            assert!(refused([3, 2], &pixels).contains("pixel (1, 1)"), "{bad}");
        }
    }
}
