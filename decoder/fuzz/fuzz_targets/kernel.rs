//! Kernels: weights, signs, tail and profile of any file that is accepted.
#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use subsurf_decoder::container::Crc;
use subsurf_decoder::kernel::layout::{ENERGY_TOLERANCE, MAX_TERMS, MAX_WEIGHT, TAPS, VARIANCES};
use subsurf_decoder::{Kernel, Section};
use subsurf_fuzz::{Arguments, check_error, mutate};

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, Section::KernelHeader)
});

fuzz_target!(|input: &[u8]| {
    match Kernel::parse_with(input, Crc::Skip) {
        Err(error) => check_error(error, input),
        Ok(kernel) => {
            let mut arguments = Arguments::behind_file(input);
            weights(&kernel);
            profile(&kernel, arguments.number());
            profile(&kernel, arguments.number().fract() * kernel.header().radius_mm);
        }
    }
});

/// Offsets, weights and signs, and what is out of range.
fn weights(kernel: &Kernel<'_>) {
    let (header, side) = (kernel.header(), kernel.header().side());
    let offsets: Vec<f32> = kernel.offsets().iter().collect();
    assert_eq!((offsets.len(), offsets[0]), (side, 0.0), "an offset for each tap of a side");
    assert!(offsets.is_sorted_by(|a, b| a < b) && offsets[side - 1] < header.radius_mm, "{offsets:?}");
    for term in 0..usize::from(MAX_TERMS) + 2 {
        let is_term = term < header.terms.into();
        let sign = kernel.sign(term);
        assert!(sign.iter().all(|s| s.abs() == f32::from(u8::from(is_term))), "{sign:?}");
        for tap in [0, side - 1, side, usize::from(TAPS[1])] {
            let weight = kernel.weight(term, tap);
            assert!(weight.iter().all(|w| w.abs() <= MAX_WEIGHT), "{weight:?}");
            assert!(is_term && tap < side || weight == [0.0; 3], "there is no tap {tap}");
        }
    }
    for (energy, reflectance) in kernel.energy().into_iter().zip(kernel.reflectance()) {
        assert!((0.0..=1.0).contains(&reflectance), "{reflectance}");
        assert!((energy - reflectance).abs() <= ENERGY_TOLERANCE * 1.001, "{energy}, {reflectance}");
    }
    if let Some(gaussians) = kernel.two_gaussians() {
        let [least, most] = VARIANCES;
        assert!(gaussians.weight.iter().all(|w| (0.0..=1.0).contains(w)), "{gaussians:?}");
        for (near, far) in gaussians.tau_near.into_iter().zip(gaussians.tau_far) {
            assert!(least <= near && near <= far && far <= most, "{gaussians:?}");
        }
    }
}

/// Tail and profile at a distance and a little further on.
fn profile(kernel: &Kernel<'_>, r_mm: f32) {
    let radius_mm = kernel.header().radius_mm;
    let [tail, further] = [r_mm, r_mm * 1.1].map(|r_mm| kernel.tail_at(r_mm));
    for (tail, further) in tail.into_iter().zip(further) {
        assert!((0.0..=1.0).contains(&tail) && further <= tail + 1e-6, "T({r_mm}) = {tail}, then {further}");
    }
    let rd = kernel.rd(r_mm);
    assert!(rd.iter().all(|rd| rd.is_finite() && *rd >= 0.0), "Rd({r_mm}) = {rd:?}");
    if r_mm.is_nan() || r_mm >= radius_mm {
        assert_eq!([tail, rd], [[0.0; 3]; 2], "nothing from {radius_mm} mm on");
    }
}
