//! Densities of drawn lights against the values of the BTF: they follow luma.
#![allow(clippy::cast_possible_truncation, reason = "numbers of tests are small")]

use std::f64::consts::FRAC_PI_2;
use subsurf_decoder::NestedBtf;
use subsurf_decoder::btf::{GridCoord, LUMA, Texel};

/// Pieces of an axis: a multiple of the cells between nodes, so that sums over their middles are exact integrals of what is linear in them.
const COUNT: usize = 96;
/// Straight lines between powers of two are up to 2 / (e ln 2) times as large.
const NEAR: f64 = 1.062;
/// Share of the draws that fall anywhere along an axis.
const ANYWHERE: f64 = 1.0 / 32.0;

/// Middles of equal pieces of a line from −`half` to `half`.
fn middles(half: f64) -> impl Iterator<Item = f64> + Clone {
    (0..COUNT).map(move |k| half * ((2 * k + 1) as f64 / COUNT as f64 - 1.0))
}

/// Light at α and sin β for a view above the x axis.
fn light(alpha: f64, sin_beta: f64) -> [f32; 3] {
    let cos_beta = (1.0 - sin_beta * sin_beta).sqrt();
    [cos_beta * alpha.sin(), sin_beta, cos_beta * alpha.cos()].map(|x| x as f32)
}

#[test]
fn densities_follow_luma_along_slices() {
    let (mut slices, mut contrast) = (0, 0.0_f64);
    for name in ["nested_display", "nested_tints"] {
        let bytes = std::fs::read(format!("../tests/vectors/{name}.subsurf")).unwrap();
        let btf = NestedBtf::parse(&bytes).unwrap();
        for (number, view) in (0..6).flat_map(|number| [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8]].map(|view| (number, view))) {
            let (texel, prepared) = (Texel::from_number(number), btf.grid().view(view));
            let sampler = btf.sampler(texel, &prepared);
            for alpha in middles(FRAC_PI_2).step_by(5) {
                let lights = middles(1.0).map(|sin_beta| light(alpha, sin_beta));
                let values: Vec<[f32; 3]> = lights
                    .clone()
                    .map(|light| btf.grid().coord_for(light, &prepared))
                    .map(|coord| btf.eval_at(texel, &GridCoord { fade: 1.0, ..coord }))
                    .collect();
                if values.as_flattened().iter().any(|value| *value <= 0.0 || *value >= 1.0) {
                    // Luma is not known where channels are cut.
                    continue;
                }
                let luma = |value: &[f32; 3]| value.iter().zip(LUMA).map(|(value, of)| f64::from(value * of)).sum();
                let lumas: Vec<f64> = values.iter().map(luma).collect();
                let densities: Vec<f64> = lights.map(|light| f64::from(sampler.pdf(light))).collect();
                let integral = |values: &[f64]| values.iter().sum::<f64>() * 2.0 / COUNT as f64;
                let [all_luma, all] = [&lumas, &densities].map(|values| integral(values));
                for (luma, density) in lumas.iter().zip(&densities) {
                    let found = (density / all - 0.5 * ANYWHERE) / (1.0 - ANYWHERE);
                    let ratio = found / (luma / all_luma);
                    assert!((1.0 / NEAR..NEAR).contains(&ratio), "{name}, {number}, {view:?}, {alpha}: {ratio}");
                    contrast = contrast.max(found * 2.0);
                }
                slices += 1;
            }
        }
    }
    assert!(slices > 50 && contrast > 1.5, "{slices} slices; the brightest lights are {contrast} times as likely");
}
