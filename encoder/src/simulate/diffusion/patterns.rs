//! Patterns of built-in materials: mixtures of measured media, and of an invented pigment, made from a seed.

use std::f64::consts::TAU;

use subsurf_decoder::bssrdf::Addressing;

use super::medium::Medium;
use crate::simulate::noise::Noise;

/// Coordinates of patterns: from pixels to periods.
pub(super) struct Pattern {
    /// Pixels after which the pattern repeats.
    pub(super) period: [f64; 2],
    /// Pixels to a side of a noise cell of frequency 1.
    noise_period: f64,
}

impl Pattern {
    /// Coordinates for a patch of `size` pixels.
    pub(super) fn new(size: [usize; 2], addressing: Addressing) -> Self {
        #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
        let [width, height] = size.map(|n| n as f64);
        // A patch that does not repeat is cut from a larger pattern.
        let period = match addressing {
            Addressing::Repeat => [width, height],
            Addressing::Clamp | Addressing::Mirror => [width.max(height).max(64.0); 2],
        };
        Self { period, noise_period: period[0].max(period[1]) }
    }

    /// Centre of a pixel in periods.
    pub(super) fn uv(&self, x: usize, y: usize) -> [f64; 2] {
        #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
        let [x, y] = [x, y].map(|n| n as f64 + 0.5);
        [x / self.period[0], y / self.period[1]]
    }

    /// Lattice cells per period for features of about `pixels`.
    pub(super) fn frequency(&self, pixels: f64) -> i64 {
        #[allow(clippy::cast_possible_truncation, reason = "saturates, and sides are below 65,536")]
        let cells = (self.noise_period / pixels).round() as i64;
        cells.max(1)
    }
}

/// Mixture of measured media, given by name.
fn mix<const N: usize>(parts: [(f64, &str); N]) -> Medium {
    let measured = |name| Medium::measured(name).expect("built-in materials name measured media only");
    Medium::mix(parts.map(|(weight, name)| (weight, measured(name))))
}

/// 0 below `from`, 1 above `to`, smooth between.
fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

pub(super) fn onyx(noise: &Noise, pattern: &Pattern, [u, v]: [f64; 2]) -> Medium {
    let layers = pattern.frequency(5.0);
    // Layers run down the patch and are folded by a wave and by noise.
    let fold = 0.6 * (TAU * v).sin() + 2.2 * noise.fractal(u, v, pattern.frequency(50.0), 4);
    #[allow(clippy::cast_precision_loss, reason = "few layers")]
    let position = u * layers as f64 + fold;
    #[allow(clippy::cast_possible_truncation, reason = "few layers")]
    let layer = position.floor() as i64;
    // Each layer's mixture: one strong part, the others weak; borders blend over a part of a layer.
    let mixture = |layer: i64| -> [f64; 4] {
        let layer = layer.rem_euclid(layers);
        let parts: [f64; 4] = std::array::from_fn(|k| {
            let k = i64::try_from(k).expect("k < 4");
            noise.value(layer * 4 + k).powi(3) + 0.02
        });
        let sum: f64 = parts.iter().sum();
        parts.map(|part| part / sum)
    };
    let blend = smoothstep(0.65, 1.0, position - position.floor());
    let (here, next) = (mixture(layer), mixture(layer + 1));
    // Layers are cloudy inside.
    let cloud = 0.5 + 0.5 * noise.fractal(v, u + 0.2, pattern.frequency(16.0), 3);
    let cloud = cloud.clamp(0.0, 1.0) * 0.35;
    let weight = |k: usize| {
        let layer = here[k] + blend * (next[k] - here[k]);
        layer * (1.0 - cloud) + if k == 3 { cloud } else { 0.0 }
    };
    // Every third layer or so is stained.
    let stain = |layer: i64| 0.08 * smoothstep(0.5, 1.0, noise.value(1000 + layer.rem_euclid(layers)));
    let stain = stain(layer) + blend * (stain(layer + 1) - stain(layer));
    let pure = 1.0 - stain;
    mix([
        (pure * weight(0), "marble"),
        (pure * weight(1), "apple"),
        (pure * weight(2), "wholemilk"),
        (pure * weight(3), "skin2"),
        (stain, "ketchup"),
    ])
}

pub(super) fn chessboard(noise: &Noise, pattern: &Pattern, [u, v]: [f64; 2]) -> Medium {
    // An even number of squares, so that the board can repeat.
    #[allow(clippy::cast_possible_truncation, reason = "few squares")]
    let square = |t: f64, period: f64| (t * (period / 20.0).round().max(1.0) * 2.0).floor() as i64;
    let (i, j) = (square(u, pattern.period[0]), square(v, pattern.period[1]));
    let white = f64::from(u8::from((i + j).rem_euclid(2) == 0));
    // Every square is a piece of its own, and every piece has a grain; dark squares are dyed.
    let piece = noise.value(i * 31 + j);
    let grain = (0.5 + 0.5 * noise.fractal(u, v, pattern.frequency(6.0), 3)).clamp(0.0, 1.0);
    let dye = (1.0 - white) * (0.05 + 0.05 * piece + 0.05 * grain);
    let cloud = 0.1 * piece + 0.2 * grain;
    mix([((1.0 - dye) * (1.0 - cloud), "marble"), ((1.0 - dye) * cloud, "apple"), (dye, "ketchup")])
}

pub(super) fn jade(noise: &Noise, pattern: &Pattern, [u, v]: [f64; 2]) -> Medium {
    let clouds = noise.fractal(u, v, pattern.frequency(32.0), 4);
    let streaks = noise.fractal(v + 0.3, u, pattern.frequency(20.0), 3);
    let a = smoothstep(-0.5, 0.5, clouds);
    let b = smoothstep(-0.6, 0.8, streaks) * 0.6;
    mix([(a * (1.0 - b), "apple"), ((1.0 - a) * (1.0 - b), "marble"), (b, "skin2")])
}

pub(super) fn marble(noise: &Noise, pattern: &Pattern, [u, v]: [f64; 2]) -> Medium {
    let vein = noise.ridge(u, v, pattern.frequency(40.0), 5, 0.07).powi(2);
    let fine = noise.ridge(v, u, pattern.frequency(18.0), 3, 0.05).powi(2) * 0.4;
    let dark = (vein + fine).min(1.0) * 0.8;
    let cloud = smoothstep(-0.5, 0.5, noise.fractal(u + 0.5, v, pattern.frequency(30.0), 4));
    let bright = 1.0 - dark;
    mix([
        (bright * (1.0 - cloud), "marble"),
        (bright * cloud, "wholemilk"),
        (dark * 0.85, "skin2"),
        (dark * 0.15, "ketchup"),
    ])
}

pub(super) fn stone(noise: &Noise, pattern: &Pattern, [u, v]: [f64; 2]) -> Medium {
    // Coarse grains, some of them white and round, and fine grit between them.
    let grain = noise.cell(u, v, [pattern.frequency(9.0); 2]);
    let grit = noise.cell(v, u, [pattern.frequency(3.5); 2]);
    let kind = noise.value(300 + grain.number);
    let speck = 1.0 - smoothstep(0.25, 0.38, grain.distance);
    let spectralon = if kind > 0.7 { 0.12 * speck } else { 0.0 };
    let inside = smoothstep(0.03, 0.15, grain.border);
    let apple = 0.45 * inside * smoothstep(0.3, 0.6, kind);
    let dark = 0.5 * smoothstep(0.45, 1.0, noise.value(700 + grit.number)) * (1.0 - speck);
    let rest = (1.0 - spectralon - apple).max(0.0);
    mix([
        (spectralon, "spectralon"),
        (apple, "apple"),
        (rest * (1.0 - dark), "marble"),
        (rest * dark * 0.6, "skin2"),
        (rest * dark * 0.4, "chicken2"),
    ])
}

/// Absorbs red most, as blue pigments do; no measured one. Coefficients in mm⁻¹ of pure pigment.
const BLUE_PIGMENT: Medium = Medium { sigma_s: [0.0; 3], sigma_a: [0.5, 0.16, 0.02] };

pub(super) fn blue_wax(noise: &Noise, pattern: &Pattern, [u, v]: [f64; 2]) -> Medium {
    // Runs of one drop over the other, thicker at their rims; each has its share of pigment.
    let bend = 0.04 * noise.fractal(u, v, pattern.frequency(40.0), 3);
    let drop = noise.cell(u + bend, v + bend, [pattern.frequency(9.0), pattern.frequency(20.0)]);
    let rim = 1.0 - smoothstep(0.0, 0.35, drop.border);
    let cloud = (0.5 + 0.5 * noise.fractal(u, v, pattern.frequency(10.0), 3)).clamp(0.0, 1.0);
    let pigment = 0.02 + 0.25 * noise.value(500 + drop.number).powi(2) + 0.12 * rim + 0.05 * cloud;
    let milky = (0.2 + 0.6 * noise.value(900 + drop.number) + 0.2 * cloud) * (1.0 - 0.5 * rim);
    Medium::mix([
        (1.0, mix([((1.0 - pigment) * milky, "wholemilk"), ((1.0 - pigment) * (1.0 - milky), "skimmilk")])),
        (pigment, BLUE_PIGMENT),
    ])
}

pub(super) fn yellow_wax(noise: &Noise, pattern: &Pattern, [u, v]: [f64; 2]) -> Medium {
    // Flakes that were pressed together: borders between them are clear, flakes are cloudy.
    let bend = 0.03 * noise.fractal(v, u, pattern.frequency(24.0), 3);
    let flake = noise.cell(u + bend, v - bend, [pattern.frequency(10.0); 2]);
    let seam = 1.0 - smoothstep(0.02, 0.2, flake.border);
    let cloud = (0.5 + 0.5 * noise.fractal(u, v, pattern.frequency(14.0), 4)).clamp(0.0, 1.0);
    let cream = 0.25 * noise.value(400 + flake.number) * (1.0 - seam);
    let apple = 0.3 * cloud;
    let stain = 0.03 * smoothstep(0.6, 1.0, noise.value(800 + flake.number));
    let rest = (1.0 - cream - apple - stain).max(0.0);
    mix([(rest, "potato"), (cream, "cream"), (apple, "apple"), (stain, "ketchup")])
}
