//! Separable bases: coefficients, and the cascade that blurs by their Gaussians.
#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use subsurf_decoder::bssrdf::basis::{MAX_GAUSSIANS, MAX_PROJECTION, MAX_TERMS, MAX_WEIGHT, WIDTHS};
use subsurf_decoder::bssrdf::{Addressing, SeparableBasis};
use subsurf_decoder::container::Crc;
use subsurf_decoder::{Bssrdf, Section};
use subsurf_fuzz::{Arguments, check_error, mutate};

/// Size of the plane that is blurred, in pixels.
const SIZE: [u32; 2] = [5, 3];
const PIXELS: usize = 15;

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, Section::BssrdfHeader)
});

fuzz_target!(|input: &[u8]| {
    match Bssrdf::parse_with(input, Crc::Skip) {
        Err(error) => check_error(error, input),
        Ok(material) => {
            if let Some(basis) = material.basis() {
                let mut arguments = Arguments::behind_file(input);
                numbers(&material, basis, [arguments.integer(), arguments.integer()]);
                blurs(basis, material.header().addressing, std::array::from_fn(|_| arguments.number()));
            }
        }
    }
});

/// Numbers of a basis, and the coefficients of a pixel.
fn numbers(material: &Bssrdf<'_>, basis: &SeparableBasis<'_>, pixel: [i32; 2]) {
    let size = basis.size();
    assert!((1..=MAX_TERMS).contains(&size.terms) && (1..=MAX_GAUSSIANS).contains(&size.gaussians), "{size:?}");
    let sigmas: Vec<f32> = basis.sigmas().collect();
    assert_eq!(sigmas.len(), size.gaussians, "a width for each Gaussian");
    assert!(sigmas.is_sorted() && sigmas.iter().all(|sigma| (WIDTHS[0]..=WIDTHS[1]).contains(sigma)), "{sigmas:?}");
    let profile = material.profile(pixel);
    for l in 0..MAX_TERMS + 1 {
        for (m, a) in (0..MAX_TERMS + 1).flat_map(|m| (0..MAX_GAUSSIANS + 1).map(move |a| (m, a))) {
            let weight = basis.weight(l, m, a);
            assert_eq!(weight, basis.weight(m, l, a), "w is symmetric");
            assert!(weight.iter().all(|w| w.abs() <= MAX_WEIGHT), "{weight:?}");
        }
        let d = basis.projection(l, usize::from(material.header().samples) - 1);
        assert!(d.iter().all(|d| d.abs() <= MAX_PROJECTION), "{d:?}");
        let coefficient = basis.coefficient(l, &profile);
        assert!(coefficient.iter().all(|c| c.is_finite() && (l < size.terms || *c == 0.0)), "{l}: {coefficient:?}");
    }
}

/// Stages of the cascade: in their ranges, and blurs of light neither lose nor make any.
fn blurs(basis: &SeparableBasis<'_>, addressing: Addressing, light: [f32; PIXELS]) {
    let cascade = basis.cascade();
    assert_eq!(cascade.stages().len(), basis.size().gaussians, "a stage for each Gaussian");
    // Of a plane of light from 0 to 1, and of an even one.
    let light = light.map(|value| if value.is_finite() { value.abs().fract() } else { 0.0 });
    let (mut plane, mut even, mut between) = (light, [1.0_f32; PIXELS], [f32::NAN; PIXELS]);
    for stage in cascade.stages() {
        assert!(stage.sigma.is_normal() && stage.sigma > 0.0 && stage.step > 0.0 && stage.sparse >= 0.0, "{stage:?}");
        assert!((1..=63).contains(&stage.taps) && stage.stride >= 1, "{stage:?}");
        stage.blur(&mut plane, &mut between, SIZE, addressing);
        stage.blur(&mut even, &mut between, SIZE, addressing);
    }
    assert!(even.iter().all(|value| (value - 1.0).abs() < 1e-4), "even light stays even: {even:?}");
    assert!(plane.iter().all(|value| (-1e-6..=1.0001).contains(value)), "{plane:?}");
    if addressing != Addressing::Clamp {
        let [before, after] = [light, plane].map(|plane| plane.iter().sum::<f32>());
        assert!((before - after).abs() < 2e-3, "{before}, {after}");
    }
}
