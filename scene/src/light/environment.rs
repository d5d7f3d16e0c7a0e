//! Light from far away, all around, as matt surfaces and as mirrors of any roughness see it.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use glam::{DVec3, Vec2, Vec3};

use crate::error::{Error, Result};

/// Levels of [`Environment::reflections`].
pub const REFLECTION_LEVELS: u32 = 6;

/// Width and height of the finest level of [`Environment::reflections`], in texels.
pub const REFLECTION_SIZE: [u32; 2] = [128, 64];

/// Directions in which a rough mirror looks, for each of its texels.
const DIRECTIONS: u16 = 512;

/// Brightest radiance of a picture: sums of it stay finite.
const BRIGHTEST: f32 = 1e30;

/// Light from all around, far away.
///
/// Pictures of it are in equirectangular projection: a direction (x, y, z), y up, is seen at
/// u = ½ + atan2(x, z) / 2π from the left and v = acos(y) / π from the top.
#[derive(Clone, Debug)]
pub struct Environment {
    irradiance: [[f32; 3]; 9],
    reflections: Vec<Vec<[f32; 3]>>,
}

impl Environment {
    /// The same radiance from everywhere, `irradiance` / π.
    ///
    /// `irradiance` is what any surface gets, linear Rec. 709.
    #[must_use]
    pub fn uniform(irradiance: [f32; 3]) -> Self {
        let mut coefficients = [[0.0; 3]; 9];
        coefficients[0] = irradiance;
        let radiance = irradiance.map(|channel| channel * FRAC_1_PI);
        let level = |k| vec![radiance; level_size(k).map(|side| side as usize).iter().product()];
        Self { irradiance: coefficients, reflections: (0..REFLECTION_LEVELS).map(level).collect() }
    }

    /// A photographer's studio without its key light: a large softbox overhead, a strip on the left, a dim floor. It has
    /// something to reflect and needs no file.
    #[must_use]
    pub fn studio() -> Self {
        const SIZE: [u32; 2] = [128, 64];
        // Full within a soft edge of 0.05 around a half width.
        let within = |distance: f32, half: f32| ((half + 0.05 - distance) / 0.1).clamp(0.0, 1.0);
        let radiance = |x: u32, y: u32| {
            #[allow(clippy::cast_precision_loss, reason = "a hundred")]
            let (u, v) = ((x as f32 + 0.5) / SIZE[0] as f32, (y as f32 + 0.5) / SIZE[1] as f32);
            let (around, down) = (std::f32::consts::TAU * (u - 0.5), std::f32::consts::PI * v);
            let direction = Vec3::new(down.sin() * around.sin(), down.cos(), down.sin() * around.cos());
            let walls = Vec3::new(0.13, 0.14, 0.16) * (1.0 + 0.4 * direction.y);
            // On a plane 1 above: the overhead box. On one 1 to the left: the strip.
            let overhead = if direction.y > 0.1 {
                let on_plane = direction / direction.y;
                within(on_plane.x.abs(), 0.8) * within((on_plane.z - 0.3).abs(), 0.6)
            } else {
                0.0
            };
            let strip = if direction.x < -0.1 {
                let on_plane = direction / -direction.x;
                within((on_plane.z - 0.9).abs(), 0.25) * within((on_plane.y - 0.2).abs(), 0.7)
            } else {
                0.0
            };
            (walls + overhead * Vec3::new(0.42, 0.44, 0.46) + strip * Vec3::new(0.7, 0.62, 0.5)).into()
        };
        let pixels: Vec<[f32; 3]> =
            (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))).map(|(x, y)| radiance(x, y)).collect();
        Self::equirectangular(SIZE, &pixels).expect("radiances of the studio are finite")
    }

    /// From a picture of `size` width and height, row by row from the top, each from the left.
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
        let in_range = |pixel: &[f32; 3]| pixel.iter().all(|channel| (0.0..=BRIGHTEST).contains(channel));
        if let Some(at) = pixels.iter().position(|pixel| !in_range(pixel)) {
            let (x, y) = (at % width as usize, at / width as usize);
            return wrong(format!("pixel ({x}, {y}) is {:?}, not between 0 and {BRIGHTEST:e}", pixels[at]));
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

/// A picture of radiance in equirectangular projection.
struct Picture {
    size: [u32; 2],
    pixels: Vec<Vec3>,
}

impl Picture {
    /// The picture at another size; each texel is the mean of the light in its solid angle.
    fn resized(&self, size: [u32; 2]) -> Self {
        let columns = shares(self.size[0], size[0], |u| u);
        let rows = shares(self.size[1], size[1], |v| -(std::f64::consts::PI * v).cos());
        let mean =
            |of: &[Vec3], shares: &[(usize, f32)]| shares.iter().map(|&(at, share)| of[at] * share).sum::<Vec3>();
        let narrow = self.pixels.chunks_exact(self.size[0] as usize);
        let narrow: Vec<Vec<Vec3>> =
            narrow.map(|row| columns.iter().map(|shares| mean(row, shares)).collect()).collect();
        let texel = |x: usize, shares: &[(usize, f32)]| shares.iter().map(|&(y, share)| narrow[y][x] * share).sum();
        let pixels = rows.iter().flat_map(|shares| (0..columns.len()).map(move |x| texel(x, shares))).collect();
        Self { size, pixels }
    }

    /// Radiance from a unit direction, linear between texels; around in u, not over the poles.
    fn radiance(&self, direction: Vec3) -> Vec3 {
        let [width, height] = self.size.map(i64::from);
        let uv = Vec2::new(0.5 + direction.x.atan2(direction.z) / TAU, direction.y.clamp(-1.0, 1.0).acos() / PI);
        let at = uv * size_of(self.size) - 0.5;
        let (low, part) = (at.floor(), at - at.floor());
        #[allow(clippy::cast_possible_truncation, reason = "within a texel of the picture")]
        let [x, y] = low.to_array().map(|k| k as i64);
        let texel = |x: i64, y: i64| {
            let at = y.clamp(0, height - 1) * width + x.rem_euclid(width);
            self.pixels[usize::try_from(at).expect("clamped to the picture")]
        };
        let row = |y| texel(x, y).lerp(texel(x + 1, y), part.x);
        row(y).lerp(row(y + 1), part.y)
    }
}

/// For each of `to` texels along an axis, which of `from` texels it covers, and which share of it each covers.
///
/// `measure` grows along the axis, over 0 to 1; shares are of its differences, and sum to 1.
fn shares(from: u32, to: u32, measure: impl Fn(f64) -> f64) -> Vec<Vec<(usize, f32)>> {
    let (n_from, n_to) = (u64::from(from), u64::from(to));
    let measure_at = |k: u64, n: u64| measure(k as f64 / n as f64);
    let texel = |k: u64| {
        let (low, high) = (measure_at(k, n_to), measure_at(k + 1, n_to));
        let covered = k * n_from / n_to..=((k + 1) * n_from - 1) / n_to;
        let share = |at: u64| {
            let part = measure_at(at + 1, n_from).min(high) - measure_at(at, n_from).max(low);
            (usize::try_from(at).expect("pictures are in memory"), single(part / (high - low)))
        };
        covered.map(share).collect()
    };
    (0..n_to).map(texel).collect()
}

/// The coefficients of [`Environment::irradiance_coefficients`].
///
/// Exact for a picture whose pixels are each of one radiance.
fn project(picture: &Picture) -> [[f32; 3]; 9] {
    use std::f64::consts::{PI, TAU};
    let [width, height] = picture.size.map(f64::from);
    let integral = |of: fn(f64) -> f64, [low, high]: [f64; 2]| of(high) - of(low);

    // ∫ 1, sin φ, cos φ, sin 2φ, cos 2φ dφ over each column, φ = 0 along z.
    let of_phi: [fn(f64) -> f64; 5] =
        [|a| a, |a| -a.cos(), |a| a.sin(), |a| -0.5 * (2.0 * a).cos(), |a| 0.5 * (2.0 * a).sin()];
    let edges = |k: u32, n: f64| [f64::from(k), f64::from(k) + 1.0].map(|edge| edge / n);
    let columns: Vec<[f64; 5]> = (0..picture.size[0])
        .map(|x| edges(x, width).map(|u| TAU * (u - 0.5)))
        .map(|phi| of_phi.map(|of| integral(of, phi)))
        .collect();
    // ∫ 1, cos θ, sin θ, sin θ cos θ, sin² θ, cos² θ times sin θ dθ over each row, θ = 0 along y.
    let of_theta: [fn(f64) -> f64; 6] = [
        |a| -a.cos(),
        |a| 0.5 * a.sin().powi(2),
        |a| 0.5 * (a - a.sin() * a.cos()),
        |a| a.sin().powi(3) / 3.0,
        |a| a.cos().powi(3) / 3.0 - a.cos(),
        |a| -a.cos().powi(3) / 3.0,
    ];

    // ∫ L P dω for each polynomial P of the sum.
    let mut sums = [DVec3::ZERO; 9];
    for (y, row) in (0..).zip(picture.pixels.chunks_exact(columns.len())) {
        let mut around = [DVec3::ZERO; 5];
        for (radiance, column) in row.iter().zip(&columns) {
            let radiance = radiance.as_dvec3();
            for k in 0..5 {
                around[k] += radiance * column[k];
            }
        }
        let [one, sin, cos, sin_2, cos_2] = around;
        let [t_one, t_cos, t_sin, t_sin_cos, t_sin_sq, t_cos_sq] =
            of_theta.map(|of| integral(of, edges(y, height).map(|v| PI * v)));
        sums[0] += one * t_one;
        sums[1] += one * t_cos;
        sums[2] += cos * t_sin;
        sums[3] += sin * t_sin;
        sums[4] += sin * t_sin_cos;
        sums[5] += cos * t_sin_cos;
        // cos² φ = (1 + cos 2φ) / 2, sin φ cos φ = sin 2φ / 2, sin² φ = (1 − cos 2φ) / 2.
        sums[6] += 1.5 * (one + cos_2) * t_sin_sq - one * t_one;
        sums[7] += 0.5 * sin_2 * t_sin_sq;
        sums[8] += 0.5 * (one - cos_2) * t_sin_sq - one * t_cos_sq;
    }

    // A_l K², with A = π, 2π/3, π/4 of the cosine lobe and Y = K P.
    let quadratic = 15.0 / 16.0;
    let factors = [0.25, 0.5, 0.5, 0.5, quadratic, quadratic, quadratic / 12.0, quadratic, quadratic / 4.0];
    std::array::from_fn(|k| (sums[k] * factors[k]).to_array().map(single))
}

/// The levels of [`Environment::reflections`].
fn reflect(picture: &Picture) -> Vec<Vec<[f32; 3]>> {
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

/// A direction in which a rough mirror looks, z along the reflection of the eye.
struct Look {
    direction: Vec3,
    /// Solid angle that the direction stands for, in sr.
    solid_angle: f32,
}

/// Where a mirror of GGX roughness looks whose normal is z, looked at along z; α = roughness². Karis 2013.
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

/// The finest source whose texels in that direction are not smaller than a solid angle in sr, which grows fourfold.
fn source_of(direction: Vec3, solid_angle: f32) -> usize {
    let sin_theta = (1.0 - direction.y * direction.y).max(0.0).sqrt();
    let [width, height] = size_of(REFLECTION_SIZE).to_array();
    let texel = (TAU / width) * (PI / height) * sin_theta.max(PI / height);
    let level = (0.5 * (solid_angle / texel).log2()).ceil().clamp(0.0, (REFLECTION_LEVELS - 1) as f32);
    #[allow(clippy::cast_possible_truncation, reason = "clamped to the levels")]
    let level = level as usize;
    level
}

fn level_size(level: u32) -> [u32; 2] {
    REFLECTION_SIZE.map(|side| side >> level)
}

fn size_of([width, height]: [u32; 2]) -> Vec2 {
    Vec2::new(width as f32, height as f32)
}

#[allow(clippy::cast_possible_truncation, reason = "rounded")]
fn single(value: f64) -> f32 {
    value as f32
}

#[cfg(test)]
mod tests {
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
