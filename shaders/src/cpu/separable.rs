//! Twin of the separable passes on a flat patch, `blur_patch_*.wgsl`, all together.

use rayon::prelude::*;
use subsurf_decoder::bssrdf::BssrdfHeader;

use crate::rgb::Rgb;
use crate::separable::{CascadeStage, SeparableBasis};

/// Exitance of the whole patch, row by row, for `irradiance` of the whole patch.
///
/// # Panics
/// If `irradiance` is shorter than the patch.
#[must_use]
pub fn separable(basis: &SeparableBasis, irradiance: &[Rgb]) -> Vec<Rgb> {
    let header = &basis.header;
    let terms = basis.size.terms;
    let area = header.pitch_mm * header.pitch_mm;
    let mut exitance = vec![[0.0; 3]; irradiance.len()];
    for l in 0..terms {
        // c_l E, then what every stage of the cascade makes of it.
        let mut map: Vec<Rgb> =
            basis.coefficients_of(l).iter().zip(irradiance).map(|(c, e)| multiply(*c, *e)).collect();
        for (a, stage) in CascadeStage::cascade(&basis.sigmas).iter().enumerate() {
            map = blur(&map, header, stage);
            for m in 0..terms {
                let weight = basis.weights_of(l, m)[a].map(|weight| weight * area);
                let coefficients = basis.coefficients_of(m);
                for ((sum, blurred), c) in exitance.iter_mut().zip(&map).zip(coefficients) {
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

/// Product by channels.
fn multiply(a: Rgb, b: Rgb) -> Rgb {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// One stage along rows and then along columns.
fn blur(image: &[Rgb], header: &BssrdfHeader, stage: &CascadeStage) -> Vec<Rgb> {
    let [width, height] = [header.width, header.height];
    let taps = stage.weights();
    let beside = |x: u32, k: i32, n: u32| header.addressing.map(x.cast_signed() + k, n);
    let across = pass([width, height], &taps, |x, y, k| image[(y * width + beside(x, k, width)) as usize]);
    pass([width, height], &taps, |x, y, k| across[(beside(y, k, height) * width + x) as usize])
}

/// Weighted sums of what lies `k` pixels from every pixel.
fn pass([width, height]: [u32; 2], taps: &[(i32, f32)], at: impl Fn(u32, u32, i32) -> Rgb + Sync) -> Vec<Rgb> {
    let sum = |x, y| {
        let mut sum = [0.0; 3];
        for &(k, weight) in taps {
            let value = at(x, y, k);
            for c in 0..3 {
                sum[c] += weight * value[c];
            }
        }
        sum
    };
    let sum = &sum;
    (0..height).into_par_iter().flat_map_iter(|y| (0..width).map(move |x| sum(x, y))).collect()
}
