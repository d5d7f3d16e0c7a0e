//! The cheapest size that an error allows.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::BssrdfHeader;

use super::radial::Radial;
use crate::cpu::{gather, separable};
use crate::rgb::Rgb;
use crate::separable::{BasisSize, MAX_TERMS, SeparableBasis};

/// Number of columns of the patch that are compared.
const COLUMNS: usize = 16;
/// Sizes `[L, A]` that are tried, from cheap to dear.
const SIZES: [[usize; 2]; 6] = [[1, 3], [1, 4], [2, 3], [2, 4], [2, 5], [2, 6]];

impl SeparableBasis {
    /// Cheapest basis whose light on some columns of the patch, lit from everywhere, by a disc and by a row, has a PSNR of at
    /// least `least_db` against the reference sum (by the largest value); the closest where none has.
    ///
    /// Takes some tenths of a second for a patch of 96 × 96 pixels.
    #[must_use]
    pub fn within(material: &Bssrdf<'_>, least_db: f32) -> Self {
        let header = *material.header();
        // A row of light is as rare on columns as on the patch. By the golden ratio: no pattern keeps step with them.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the width")]
        let column = |k: u8| ((f64::from(k) * 0.618_034).fract() * f64::from(header.width)) as u32;
        let columns: [u32; COLUMNS] = std::array::from_fn(|k| column(u8::try_from(k).unwrap_or(0)));
        let trials: Vec<(Vec<Rgb>, Vec<Rgb>)> = lights(&header)
            .map(|light| {
                let gathered = columns.iter().map(|&column| gather(material, &light, [column, 0], [1, header.height]));
                let expected = gathered.flatten().collect();
                (light, expected)
            })
            .into();
        let width = header.width as usize;
        let quality = |basis: &Self| {
            let of_trial = |(light, expected): &(Vec<Rgb>, Vec<Rgb>)| {
                let all = separable(basis, light);
                let found: Vec<Rgb> =
                    columns.iter().flat_map(|&column| all[column as usize..].iter().step_by(width).copied()).collect();
                psnr_db(expected, &found)
            };
            trials.iter().map(of_trial).fold(f32::INFINITY, f32::min)
        };
        let radial = Radial::of(material, MAX_TERMS);
        let mut best: Option<(f32, Self)> = None;
        for [terms, gaussians] in SIZES {
            let basis = Self::from_radial(header, radial.clone().truncated(terms), BasisSize { terms, gaussians });
            let reached = quality(&basis);
            if reached >= least_db {
                return basis;
            }
            if best.as_ref().is_none_or(|(most, _)| reached > *most) {
                best = Some((reached, basis));
            }
        }
        best.map_or_else(|| Self::of(material, BasisSize::default()), |(_, basis)| basis)
    }
}

/// Irradiance from everywhere, of a disc of a third of the patch in its middle, and of the row through a third.
fn lights(header: &BssrdfHeader) -> [Vec<Rgb>; 3] {
    let [width, height] = [header.width, header.height];
    let of = |lit: &dyn Fn(u32, u32) -> bool| -> Vec<Rgb> {
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        pixels.map(|(x, y)| [f32::from(u8::from(lit(x, y))); 3]).collect()
    };
    #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
    let from_middle = |x: u32, y: u32| {
        let [dx, dy] = [x as f32 + 0.5 - 0.5 * width as f32, y as f32 + 0.5 - 0.5 * height as f32];
        (dx * dx + dy * dy).sqrt()
    };
    #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
    let radius = width.min(height) as f32 / 3.0;
    let line = height / 3;
    [of(&|_, _| true), of(&|x, y| from_middle(x, y) < radius), of(&|_, y| y == line)]
}

/// PSNR in dB, by the largest expected value.
fn psnr_db(expected: &[Rgb], found: &[Rgb]) -> f32 {
    let peak = expected.iter().flatten().copied().fold(1e-30, f32::max);
    let squares = expected.iter().flatten().zip(found.iter().flatten()).map(|(a, b)| ((a - b) / peak).powi(2));
    #[allow(clippy::cast_precision_loss, reason = "a few columns")]
    let mean = squares.sum::<f32>() / (3 * expected.len()) as f32;
    -10.0 * mean.log10()
}
