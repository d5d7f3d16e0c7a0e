//! Built-in rough materials by name, and their reliefs.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::height_field::Relief;
use super::reflectance::Finish;
use crate::simulate::noise::Noise;

/// A built-in, synthetic rough material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sample {
    /// Creased metal foil.
    Foil,
    /// Dark leather with a grain, under a thin polish.
    Leather,
    /// Corduroy: ribs of cut pile.
    Corduroy,
    /// Knitted wool of two colours.
    Knit,
    /// Figured wood under a clear coat.
    Wood,
}

/// One place of a pattern; heights are parts of its side.
struct Point {
    height: f32,
    finish: Finish,
}

impl Sample {
    /// All materials.
    pub const ALL: [Self; 5] = [Self::Foil, Self::Leather, Self::Corduroy, Self::Knit, Self::Wood];

    /// Name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Foil => "foil",
            Self::Leather => "leather",
            Self::Corduroy => "corduroy",
            Self::Knit => "knit",
            Self::Wood => "wood",
        }
    }

    /// Appearance in a few words.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Foil => "creased metal foil, smooth and glossy",
            Self::Leather => "dark leather, a grain of cells with grooves between",
            Self::Corduroy => "ribs of cut pile, dark where one looks into it",
            Self::Knit => "knitted wool in two colours, loops over each other",
            Self::Wood => "figured wood under a clear coat; its highlights move with the fibres",
        }
    }

    /// Relief of `side` × `side` texels, which repeats.
    pub(super) fn relief(self, side: usize, seed: u64) -> Relief {
        let noise = Noise::new(seed);
        let points: Vec<Point> = (0..side * side)
            .map(|k| {
                let place = Vec2::new((k % side) as f32 + 0.5, (k / side) as f32 + 0.5) / side as f32;
                match self {
                    Self::Foil => foil(&noise, place),
                    Self::Leather => leather(&noise, place),
                    Self::Corduroy => corduroy(&noise, place),
                    Self::Knit => knit(&noise, place),
                    Self::Wood => wood(&noise, place),
                }
            })
            .collect();
        let heights = points.iter().map(|point| point.height * side as f32).collect();
        Relief::new(side, heights, points.into_iter().map(|point| point.finish).collect())
    }
}

#[allow(clippy::cast_possible_truncation, reason = "noise")]
fn fractal(noise: &Noise, at: Vec2, frequency: i64, octaves: i32) -> f32 {
    noise.fractal(at.x.into(), at.y.into(), frequency, octaves) as f32
}

fn foil(noise: &Noise, at: Vec2) -> Point {
    // Creases: folded noise is sharp where it turns.
    let folded = fractal(noise, at, 3, 3).abs();
    let specular = Vec3::new(0.75, 0.64, 0.42) * (0.95 + 0.05 * fractal(noise, at, 16, 2));
    let finish = Finish { specular, roughness: [0.55, 0.55], ..Finish::matte(Vec3::splat(0.01)) };
    Point { height: 0.035 * folded, finish }
}

#[allow(clippy::cast_possible_truncation, reason = "noise")]
fn leather(noise: &Noise, at: Vec2) -> Point {
    let warped = at + 0.02 * Vec2::new(fractal(noise, at, 4, 2), fractal(noise, at + 0.37, 4, 2));
    let cell = noise.cell(warped.x.into(), warped.y.into(), [11, 11]);
    let (border, number) = (cell.border as f32, cell.number);
    // Cushions with grooves between, and pores.
    let cushion = (border / 0.45).min(1.0);
    let cushion = cushion * (2.0 - cushion);
    let fine = fractal(noise, at, 40, 2);
    let tint = 1.0 + 0.25 * (noise.value(number) as f32 - 0.5) + 0.2 * fractal(noise, at, 5, 3);
    let diffuse = Vec3::new(0.17, 0.075, 0.04) * tint * (0.45 + 0.55 * cushion);
    let finish = Finish {
        specular: Vec3::splat(0.045),
        roughness: [0.48 - 0.1 * cushion, 0.48 - 0.1 * cushion],
        ..Finish::matte(diffuse)
    };
    // Eleven cells are some 25 mm; grain is about 0.2 mm deep.
    Point { height: 0.008 * cushion + 0.001 * fine, finish }
}

fn corduroy(noise: &Noise, at: Vec2) -> Point {
    const RIBS: f32 = 9.0;
    let wander = 0.06 * fractal(noise, Vec2::new(0.3, at.y), 6, 2);
    let across = (at.x * RIBS + wander).rem_euclid(1.0) * 2.0 - 1.0;
    // A rib is nearly half a cylinder; pile stands on it.
    let profile = (1.0 - (across.abs() * 0.97).powi(4)).max(0.0).sqrt();
    let tuft = fractal(noise, at, 64, 1);
    let wear = fractal(noise, at, 3, 3);
    let diffuse = Vec3::new(0.30, 0.19, 0.07) * (0.55 + 0.45 * profile) * (1.0 + 0.25 * tuft + 0.15 * wear);
    // The ends of the hairs lean down the ribs and are brightest against the light.
    let lean = Vec3::new(0.15 * tuft, 0.55 + 0.2 * wear, 0.8).normalize();
    let finish = Finish {
        fibre_colour: Vec3::new(0.16, 0.12, 0.06) * profile,
        fibre_width_rad: 0.45,
        fibre: lean.cross(Vec3::X).normalize(),
        ..Finish::matte(diffuse)
    };
    Point { height: 0.045 * profile + 0.006 * tuft, finish }
}

fn knit(noise: &Noise, at: Vec2) -> Point {
    // Stitches: a column is two legs wide, and the legs of a V lean towards each other.
    const COLUMNS: f32 = 8.0;
    const ROWS: f32 = 10.0;
    let mut best = Point { height: 0.0, finish: Finish::matte(Vec3::splat(0.02)) };
    let (u, v) = (at.x * COLUMNS, at.y * ROWS);
    for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
        #[allow(clippy::cast_precision_loss, reason = "small")]
        let (column, row) = (u.floor() + dx as f32, v.floor() + dy as f32);
        for leg in [-1.0_f32, 1.0] {
            let jitter = 0.05 * fractal(noise, Vec2::new(column / COLUMNS, row / ROWS) + 0.013, 32, 1);
            let centre = Vec2::new(column + 0.5 + 0.25 * leg, row + 0.5 + jitter);
            let away = (Vec2::new(u, v) - centre) / Vec2::new(COLUMNS, ROWS);
            // An ellipsoid along the leg.
            let along = Vec2::new(-0.42 * leg, 1.0).normalize();
            let (a, b) = (away.dot(along), away.dot(Vec2::new(-along.y, along.x)));
            let inside = 1.0 - (a / 0.078).powi(2) - (b / 0.034).powi(2);
            if inside <= 0.0 {
                continue;
            }
            // Loops go under the ones above.
            let twist = (a * 260.0 + b * 110.0 * leg).sin();
            let height = 0.034 * inside.sqrt() + 0.02 * a / 0.078 * 0.4 + 0.0012 * twist;
            if height > best.height {
                let is_second = (row.rem_euclid(ROWS) / 5.0).floor().rem_euclid(2.0) > 0.5;
                let wool = if is_second { Vec3::new(0.62, 0.57, 0.47) } else { Vec3::new(0.34, 0.07, 0.08) };
                let shade = 1.0 + 0.12 * twist + 0.2 * fractal(noise, at, 48, 2);
                let finish = Finish {
                    specular: Vec3::splat(0.03),
                    roughness: [0.75, 0.5],
                    fibre: Vec3::new(along.x, along.y, 0.0),
                    ..Finish::matte(wool * shade)
                };
                best = Point { height, finish };
            }
        }
    }
    best
}

fn wood(noise: &Noise, at: Vec2) -> Point {
    // Rings cut lengthwise, and fibres that lean up and down in waves: the figure.
    let bend = 0.5 * fractal(noise, Vec2::new(at.x, 0.5 * at.y), 2, 3);
    let rings = (TAU * (5.0 * at.x + bend)).sin();
    let late = (0.5 + 0.5 * rings).powi(4);
    let pores = (fractal(noise, Vec2::new(at.x, at.y * 0.125), 64, 1) - 0.42).max(0.0) * 4.0;
    let lean = 0.30 * (TAU * (3.0 * at.y + 0.6 * fractal(noise, at, 2, 2))).sin() + 0.1 * fractal(noise, at, 6, 2);
    let sway = 0.12 * bend;
    let fibre = Vec3::new(sway, lean.cos(), lean.sin()).normalize();
    let colour = Vec3::new(0.46, 0.27, 0.13).lerp(Vec3::new(0.23, 0.11, 0.05), late) * (1.0 - 0.5 * pores.min(1.0));
    let finish = Finish {
        specular: Vec3::splat(0.04),
        roughness: [0.45, 0.45],
        fibre,
        fibre_colour: Vec3::new(0.30, 0.19, 0.09) * (1.0 - 0.6 * late),
        fibre_width_rad: 10.0 * PI / 180.0,
        ..Finish::matte(0.55 * colour)
    };
    Point { height: -0.002 * pores.min(1.0), finish }
}
