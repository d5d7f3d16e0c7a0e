//! Separable bases: the section's numbers and limits, and the cascade by its formulas.
#![allow(clippy::cast_possible_truncation, reason = "numbers of tests are small")]

use crate::common::{HEADER, bssrdf, floats};
use subsurf_decoder::bssrdf::basis::{BasisSize, Cascade};
use subsurf_decoder::{Bssrdf, ReadError, Section};

/// Bytes before the section: container of five sections, header, profiles, ratios and indices.
fn section_at() -> u64 {
    24 + 24 * 5 + 4 + HEADER.to_bytes().len() as u64 + 48 + 8 + 4
}

/// Both materials of the example with ln 4 and ln 16, −ln 4 and 0, ...
const PROFILES: [f32; 12] = [1.386_294_4, 2.772_588_7, 0.0, -1.386_294_4, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

fn with_basis(section: &[u8]) -> Vec<u8> {
    let (profiles, ratios) = (floats(&PROFILES), floats(&[1.0, 0.25]));
    bssrdf(HEADER, &[(b"PROF", &profiles), (b"MIXR", &ratios), (b"BIDX", &[0, 1, 1, 0]), (b"sepb", section)])
}

fn error_of(section: &[u8]) -> Option<ReadError> {
    Bssrdf::parse(&with_basis(section)).err()
}

/// Section of L = 2 and A = 2: widths, weights and factors, all of them different.
fn numbers() -> Vec<f32> {
    let weights = (0..18_u8).map(|k| 10.0 + f32::from(k));
    let factors = (0..12_u8).map(|k| 100.0 + f32::from(k));
    [0.5, 2.0].into_iter().chain(weights).chain(factors).collect()
}

fn section(numbers: &[f32]) -> Vec<u8> {
    [&[2, 2, 0, 0][..], &floats(numbers)].concat()
}

#[test]
fn numbers_stand_where_the_format_has_them() {
    let file = with_basis(&section(&numbers()));
    let material = Bssrdf::parse(&file).unwrap();
    let basis = material.basis().unwrap();
    assert_eq!(basis.size(), BasisSize { terms: 2, gaussians: 2 });
    assert!(basis.sigmas().eq([0.5, 2.0]), "widths");
    // Pairs (0, 0), (0, 1) and (1, 1), both Gaussians of each.
    for (l, m, a, first) in
        [(0, 0, 0, 10.0), (0, 0, 1, 13.0), (0, 1, 0, 16.0), (1, 0, 1, 19.0), (1, 1, 0, 22.0), (1, 1, 1, 25.0)]
    {
        assert_eq!(basis.weight(l, m, a), [first, first + 1.0, first + 2.0], "{l}, {m}, {a}");
    }
    for (l, m, a) in [(2, 0, 0), (0, 2, 0), (0, 0, 2)] {
        assert_eq!(basis.weight(l, m, a), [0.0; 3], "{l}, {m}, {a}");
    }
    for (l, h, first) in [(0, 0, 100.0), (0, 1, 103.0), (1, 0, 106.0), (1, 1, 109.0)] {
        assert_eq!(basis.projection(l, h), [first, first + 1.0, first + 2.0], "{l}, {h}");
    }
    assert_eq!([basis.projection(2, 0), basis.projection(0, 2)], [[0.0; 3]; 2]);
    // exp(½ P̂) of pixel 0, which is material 0: 2, 4 and 1 at the first node, ½, 1 and 1 at the second.
    let due = [2.0 * 106.0 + 0.5 * 109.0, 4.0 * 107.0 + 110.0, 108.0 + 111.0];
    let found = basis.coefficient(1, &material.profile([0, 0]));
    for (found, due) in found.into_iter().zip(due) {
        assert!((found - due).abs() < 1e-3, "{found} is not {due}");
    }
    assert_eq!(basis.cascade(), Cascade::new([0.5, 2.0]));
}

#[test]
fn sizes() {
    let size = |terms, gaussians| BasisSize { terms, gaussians };
    assert_eq!(size(2, 4).section_bytes(13), 476);
    assert_eq!(size(1, 1).section_bytes(2), 4 + 4 + 12 + 24);
    assert_eq!([size(1, 3), size(2, 3)].map(BasisSize::pairs), [1, 3]);
    let of_two = size(2, 1);
    assert_eq!([(0, 0), (0, 1), (1, 0), (1, 1)].map(|(l, m)| of_two.pair(l, m)), [0, 1, 1, 2]);
    assert_eq!(size(2, 7).to_bytes(), [2, 7, 0, 0]);
    for (terms, gaussians, is_in_range) in
        [(1, 1, true), (2, 8, true), (0, 1, false), (3, 1, false), (1, 0, false), (1, 9, false)]
    {
        assert_eq!(size(terms, gaussians).is_in_range(), is_in_range, "{terms}, {gaussians}");
        let error = error_of(&[terms as u8, gaussians as u8, 0, 0]);
        let is_field = matches!(error, Some(ReadError::BadField { section: Section::SeparableBasis, .. }));
        assert_eq!(is_field, !is_in_range, "{terms}, {gaussians}: {error:?}");
    }
    let wrong = |need_bytes, have_bytes| {
        Some(ReadError::WrongSize { section: Section::SeparableBasis, need_bytes, have_bytes })
    };
    assert_eq!(error_of(&[1, 1, 0]), wrong(4, 3));
    assert_eq!(error_of(&[1, 1, 0, 0]), wrong(44, 4), "numbers are missing");
    assert_eq!(error_of(&section(&numbers()[1..])), wrong(132, 128));
}

#[test]
fn ranges_of_numbers() {
    // Places of both widths, of the first and last weight, and of the first and last factor.
    let cases: [(usize, [f32; 2]); 6] = [
        (0, [0.125, 2.0]),
        (1, [0.5, 8.0]),
        (2, [-1e6, 1e6]),
        (19, [-1e6, 1e6]),
        (20, [-1e15, 1e15]),
        (31, [-1e15, 1e15]),
    ];
    let with = |at: usize, value: f32| {
        let mut numbers = numbers();
        numbers[at] = value;
        error_of(&section(&numbers))
    };
    for (at, [min, max]) in cases {
        assert_eq!([min, max].map(|value| with(at, value)), [None, None], "number {at}");
        for value in [min.next_down(), max.next_up(), f32::INFINITY, f32::NEG_INFINITY] {
            // Where the first width is too large, it is the second that is refused.
            let place = if at == 0 && (2.0..=16.0).contains(&value) { 1 } else { at };
            let found = with(at, value);
            let offset = section_at() + 4 + 4 * place as u64;
            let is_due = matches!(found, Some(ReadError::BadNumber { section: Section::SeparableBasis, offset: at, .. }) if at == offset);
            assert!(is_due, "number {at}, {value}: {found:?}");
        }
        assert!(with(at, f32::NAN).is_some(), "NaN as number {at}");
    }
    // The first width is at most 16 pixels, and no width is above 1,023.
    let widths = |first: f32, second: f32| {
        let mut numbers = numbers();
        (numbers[0], numbers[1]) = (first, second);
        error_of(&section(&numbers)).is_none()
    };
    assert!(widths(16.0, 256.0) && !widths(16.0_f32.next_up(), 256.0), "first width");
    assert!(!widths(16.0, 256.0_f32.next_up()), "sixteen times as wide");
}

#[test]
fn the_widest_gaussian_has_1023_pixels() {
    // Three Gaussians of one term.
    let with_last = |sigma: f32| {
        let numbers = [&[16.0, 255.0, sigma][..], &[0.0; 9 + 6]].concat();
        error_of(&[&[1, 3, 0, 0][..], &floats(&numbers)].concat())
    };
    assert_eq!(with_last(1_023.0), None);
    assert!(matches!(with_last(1_023.0_f32.next_up()), Some(ReadError::BadNumber { max: 1_023.0, .. })), "too wide");
}

/// Variance of taps at k · stride of a Gaussian, |k| ≤ taps.
fn variance(sigma: f64, stride: f64, taps: i32) -> f64 {
    let weight = |k: i32| (-0.5 * (f64::from(k) * stride / sigma).powi(2)).exp();
    let sum: f64 = (-taps..=taps).map(weight).sum();
    (-taps..=taps).map(|k| weight(k) * (f64::from(k) * stride).powi(2)).sum::<f64>() / sum
}

#[test]
fn stages_follow_the_formulas() {
    let close = |found: f32, due: f64| (f64::from(found) - due).abs() < 1e-4 * due.max(1.0);
    for sigmas in
        [&[0.125, 0.25, 0.5, 0.75][..], &[0.5, 1.1, 3.9, 4.1, 20.0], &[5.0, 20.0, 300.0, 1_023.0], &[2.0, 2.0]]
    {
        let mut reached = 0.0;
        let cascade = Cascade::new(sigmas.iter().copied());
        assert_eq!(cascade.stages().len(), sigmas.len(), "a stage for each width");
        for (stage, &sigma) in cascade.stages().iter().zip(sigmas) {
            // V_a of a Gaussian at whole pixels, and what is left of it.
            let wanted = (variance(sigma.into(), 1.0, 8_200) - reached).max(1e-6);
            let sparse = 1.8 * f64::sqrt(reached);
            let stride = sparse.floor().max(1.0);
            let taps = (3.2 * wanted.sqrt() / stride).ceil().max(1.0);
            assert_eq!((f64::from(stage.stride), f64::from(stage.taps)), (stride, taps), "{sigma}");
            assert!(close(stage.step, wanted.sqrt()) && close(stage.sparse, sparse), "{sigma}: {stage:?}");
            let found = variance(stage.sigma.into(), stride, stage.taps);
            assert!((found - wanted).abs() < 1e-4 * wanted + 1e-6, "{sigma}: variance {found}, not {wanted}");
            reached += found;
        }
    }
}

#[test]
fn taps_are_gaussian_weights_of_sum_one() {
    for stage in Cascade::new([0.6, 1.5, 4.0]).stages() {
        // Light in the middle of a row of 81 pixels.
        let (mut line, mut between) = ([0.0_f32; 81], [f32::NAN; 81]);
        line[40] = 1.0;
        stage.blur(&mut line, &mut between, [81, 1], subsurf_decoder::bssrdf::Addressing::Clamp);
        let weight = |k: i32| (-0.5 * (f64::from(k * stage.stride) / f64::from(stage.sigma)).powi(2)).exp();
        let sum: f64 = (-stage.taps..=stage.taps).map(weight).sum();
        for (x, found) in (-40_i32..).zip(line) {
            let k = x / stage.stride;
            let is_tap = x % stage.stride == 0 && k.abs() <= stage.taps;
            let due = if is_tap { weight(k) / sum } else { 0.0 };
            assert!((f64::from(found) - due).abs() < 1e-6, "{stage:?}: {found} at {x} is not {due}");
        }
    }
}

#[test]
fn planes_without_pixels_stay_as_they_are() {
    let cascade = Cascade::new([2.0]);
    for size in [[0, 2], [2, 0], [3, 1]] {
        let (mut plane, mut between) = ([1.0, 5.0], [7.0, 7.0]);
        cascade.stages()[0].blur(&mut plane, &mut between, size, subsurf_decoder::bssrdf::Addressing::Repeat);
        assert_eq!((plane, between), ([1.0, 5.0], [7.0, 7.0]), "{size:?}");
    }
}
