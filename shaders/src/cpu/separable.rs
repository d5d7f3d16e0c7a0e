//! Twin of the separable passes on a flat patch.

#![allow(clippy::cast_possible_truncation, reason = "results in double precision are kept in single; counts are small")]

use rayon::prelude::*;
use subsurf_decoder::bssrdf::Header;

use super::Rgb;
use crate::separable::Factors;
use crate::uniform::reach;

/// Exitance of the whole patch, row by row, for `irradiance` of the whole patch.
///
/// # Panics
/// If `irradiance` is shorter than the patch.
#[must_use]
pub fn separable(factors: &Factors, irradiance: &[Rgb]) -> Vec<Rgb> {
    let header = &factors.header;
    let terms = factors.detail.terms;
    let area = header.pitch_mm * header.pitch_mm;
    let mut exitance = vec![[0.0; 3]; irradiance.len()];
    for l in 0..terms {
        // c_l E.
        let weighted: Vec<Rgb> =
            factors.coefficients_of(l).iter().zip(irradiance).map(|(c, e)| multiply(*c, *e)).collect();
        for (a, &sigma) in factors.sigmas.iter().enumerate() {
            let blurred = blur(&weighted, header, sigma);
            for m in 0..terms {
                let weight = factors.weights_of(l, m)[a].map(|weight| weight * area);
                let coefficients = factors.coefficients_of(m);
                for ((sum, blurred), c) in exitance.iter_mut().zip(&blurred).zip(coefficients) {
                    let light = multiply(multiply(*c, weight), *blurred);
                    for k in 0..3 {
                        sum[k] += light[k];
                    }
                }
            }
        }
    }
    exitance
}

fn multiply(a: Rgb, b: Rgb) -> Rgb {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// Convolution with a Gaussian of sum 1, along rows and then along columns.
fn blur(image: &[Rgb], header: &Header, sigma: f32) -> Vec<Rgb> {
    let [width, height] = [header.width, header.height];
    let taps = taps(sigma);
    let across = pass(
        image,
        width,
        |x, y, k| {
            let column = header.addressing.map(x.cast_signed() + k, width);
            (y * width + column) as usize
        },
        &taps,
    );
    pass(
        &across,
        width,
        |x, y, k| {
            let row = header.addressing.map(y.cast_signed() + k, height);
            (row * width + x) as usize
        },
        &taps,
    )
}

fn pass(image: &[Rgb], width: u32, at: impl Fn(u32, u32, i32) -> usize + Sync, taps: &[(i32, f32)]) -> Vec<Rgb> {
    let rows = image.par_chunks(width as usize).zip(0_u32..image.len() as u32 / width);
    let rows = rows.flat_map_iter(|(_, y)| {
        let at = &at;
        (0..width).map(move |x| {
            let mut sum = [0.0; 3];
            for &(k, weight) in taps {
                let value = image[at(x, y, k)];
                for c in 0..3 {
                    sum[c] += weight * value[c];
                }
            }
            sum
        })
    });
    rows.collect()
}

/// Offsets and weights of a Gaussian, of sum 1.
fn taps(sigma: f32) -> Vec<(i32, f32)> {
    let reach = reach(sigma);
    let weight = |k: i32| (-0.5 * (k as f32 / sigma).powi(2)).exp();
    let sum: f32 = (-reach..=reach).map(weight).sum();
    (-reach..=reach).map(|k| (k, weight(k) / sum)).collect()
}
