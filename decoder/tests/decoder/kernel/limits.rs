//! Limits and values of kernels: what is allowed up to the last value, and what the numbers stand for.
#![allow(clippy::cast_possible_truncation, reason = "numbers of tests are small")]

use crate::common::{assemble, floats};
use subsurf_decoder::kernel::{KernelHeader, KernelMethod, TwoGaussians};
use subsurf_decoder::{Kernel, ReadError, Section};

/// One term of five taps, two nodes of the tail.
const HEADER: KernelHeader = KernelHeader {
    method: KernelMethod::Svd,
    terms: 1,
    taps: 5,
    tail_nodes: 2,
    signs: 0,
    radius_mm: 2.0,
    depth_variance: 1.0,
    eta: 1.5,
};

/// First byte of the header section of a file that has no other one.
const HEADER_AT: u64 = 24 + 24 + 4;

fn refusal(header: &[u8]) -> ReadError {
    Kernel::parse(&assemble(&[(b"KERN", header)])).unwrap_err()
}

#[test]
fn fields_of_the_header() {
    type Change = fn(&mut KernelHeader, u32);
    let cases: [(&str, Change, &[u32], &[u32]); 5] = [
        ("terms", |h, x| h.terms = x as u8, &[0, 7], &[1, 6]),
        ("taps", |h, x| h.taps = x as u8, &[0, 3, 4, 6, 64, 66, 67], &[5, 7, 65]),
        ("tail_nodes", |h, x| h.tail_nodes = x as u16, &[0, 1, 1_025], &[2, 1_024]),
        ("signs of one term", |h, x| h.signs = x, &[8, u32::MAX], &[0, 7]),
        ("signs of six terms", |h, x| (h.terms, h.signs) = (6, x), &[1 << 18, 1 << 31], &[(1 << 18) - 1]),
    ];
    for (name, change, refused, allowed) in cases {
        let error_of = |value: u32| {
            let mut header = HEADER;
            change(&mut header, value);
            refusal(&header.to_bytes())
        };
        for &value in refused {
            let error = error_of(value);
            let is_due = matches!(error, ReadError::BadField { section: Section::KernelHeader, value: found, .. } if found == value);
            assert!(is_due, "{name} {value}: {error}");
        }
        for &value in allowed {
            assert_eq!(error_of(value), ReadError::Missing { section: Section::KernelWeights }, "{name} {value}");
        }
    }
    // The method and the colour space are the first two bytes.
    for (at, value, is_allowed) in
        [(0, 0, false), (0, 6, false), (0, 5, true), (1, 0, false), (1, 2, false), (1, 1, true)]
    {
        let mut header = HEADER.to_bytes();
        header[at] = value;
        let bad_field =
            ReadError::BadField { section: Section::KernelHeader, offset: HEADER_AT + at as u64, value: value.into() };
        let due = if is_allowed { ReadError::Missing { section: Section::KernelWeights } } else { bad_field };
        assert_eq!(refusal(&header), due);
    }
}

#[test]
fn lengths_variances_and_refractive_index() {
    type Change = fn(&mut KernelHeader, f32);
    let cases: [(u64, Change, [f32; 2]); 3] = [
        (12, |h, x| h.radius_mm = x, [1e-6, 1e6]),
        (16, |h, x| h.depth_variance = x, [1e-12, 1e12]),
        (20, |h, x| h.eta = x, [1.0, 4.0]),
    ];
    for (at, change, [min, max]) in cases {
        let error_of = |value: f32| {
            let mut header = HEADER;
            change(&mut header, value);
            refusal(&header.to_bytes())
        };
        for value in [min, max] {
            assert_eq!(error_of(value), ReadError::Missing { section: Section::KernelWeights }, "{value} at {at}");
        }
        for value in [min.next_down(), max.next_up()] {
            let due = ReadError::BadNumber { section: Section::KernelHeader, offset: HEADER_AT + at, value, min, max };
            assert_eq!(error_of(value), due);
        }
    }
}

#[test]
fn methods_and_sizes() {
    let names = ["svd", "pre-integrated", "guided", "two-gaussians", "gaussians"];
    for ((code, method), name) in (1_u8..).zip(KernelMethod::ALL).zip(names) {
        assert_eq!((method.code(), KernelMethod::from_code(code), method.name()), (code, Some(method), name));
    }
    let header = KernelHeader { terms: 2, taps: 7, tail_nodes: 5, ..HEADER };
    assert_eq!(header.side(), 4);
    let sizes = [
        (Section::KernelHeader, HEADER.to_bytes().len() as u64),
        (Section::KernelOffsets, 16),
        (Section::KernelWeights, 96),
        (Section::KernelTail, 60),
        (Section::TwoGaussians, 36),
        (Section::BaseProfiles, 0),
    ];
    for (section, bytes) in sizes {
        assert_eq!(header.section_bytes(section), bytes, "{section}");
    }
}

/// Numbers of a kernel of one term, the same in all channels.
#[derive(Clone, Copy)]
struct Numbers {
    offsets: [f32; 3],
    weights: [f32; 3],
    tail: [f32; 2],
}

/// (½ + 0 + 0)² = ¼.
const NUMBERS: Numbers = Numbers { offsets: [0.0, 0.5, 1.0], weights: [0.5, 0.0, 0.0], tail: [0.25, 0.0] };

fn rgb(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| floats(&[*value; 3])).collect()
}

fn file(numbers: &Numbers, two_gaussians: &[f32]) -> Vec<u8> {
    let [offsets, weights, tail] = [floats(&numbers.offsets), rgb(&numbers.weights), rgb(&numbers.tail)];
    let (header, two_gaussians) = (HEADER.to_bytes(), floats(two_gaussians));
    let sections: [(&[u8; 4], &[u8]); 5] =
        [(b"KERN", &header), (b"KOFF", &offsets), (b"KWGT", &weights), (b"TAIL", &tail), (b"twog", &two_gaussians)];
    assemble(&sections[..if two_gaussians.is_empty() { 4 } else { 5 }])
}

/// Section in which a number is refused, and which number of it.
fn refused_at(numbers: &Numbers, two_gaussians: &[f32]) -> Option<(Section, u64)> {
    let sections = if two_gaussians.is_empty() { 4 } else { 5 };
    let header_end = 24 + 24 * sections + 4 + HEADER.to_bytes().len() as u64;
    match Kernel::parse(&file(numbers, two_gaussians)).err()? {
        ReadError::BadNumber { section, offset, .. } => {
            let before = match section {
                Section::KernelOffsets => 0,
                Section::KernelWeights => 12,
                Section::KernelTail => 12 + 36,
                _ => 12 + 36 + 24,
            };
            Some((section, (offset - header_end - before) / 4))
        }
        error => panic!("{error}"),
    }
}

#[test]
fn offsets_rise_from_0_to_below_the_radius() {
    let cases = [
        ([0.0, 0.5, 1.0], None),
        ([0.0, f32::from_bits(1), 2.0_f32.next_down()], None),
        ([f32::from_bits(1), 0.5, 1.0], Some(0)),
        ([-0.5, 0.5, 1.0], Some(0)),
        ([0.0, 0.0, 1.0], Some(1)),
        ([0.0, 0.5, 0.5], Some(2)),
        ([0.0, 0.5, 2.0], Some(2)),
        ([0.0, f32::NAN, 1.0], Some(1)),
    ];
    for (offsets, at) in cases {
        let found = refused_at(&Numbers { offsets, ..NUMBERS }, &[]);
        assert_eq!(found, at.map(|at| (Section::KernelOffsets, at)), "{offsets:?}");
    }
}

#[test]
fn weights_stay_within_16_and_keep_the_energy() {
    let above = 16.0_f32.next_up();
    let cases = [
        ([16.0, -8.0, 0.25], None),
        ([16.0, -16.0, 8.25], None),
        ([above, -8.0, 0.25], Some(0)),
        ([16.0, -above, 8.25], Some(3)),
        ([16.0, -8.0, f32::NAN], Some(6)),
        // What the weights add up to is told with the first of them.
        ([0.5, 0.0, 0.125], Some(0)),
    ];
    for (weights, at) in cases {
        let found = refused_at(&Numbers { weights, ..NUMBERS }, &[]);
        assert_eq!(found, at.map(|at| (Section::KernelWeights, at)), "{weights:?}");
    }
    let step = 1.0_f32 / 1024.0;
    for (reflectance, is_allowed) in [
        (0.25 + step, true),
        (0.25 - step, true),
        ((0.25_f32 + step).next_up(), false),
        ((0.25_f32 - step).next_down(), false),
    ] {
        let found = refused_at(&Numbers { tail: [reflectance, 0.0], ..NUMBERS }, &[]);
        assert_eq!(found, (!is_allowed).then_some((Section::KernelWeights, 0)), "{reflectance}");
    }
}

#[test]
fn tails_fall_from_at_most_1_to_0() {
    let cases = [
        ([1.0, 0.0], Some((Section::KernelWeights, 0))),
        ([1.0_f32.next_up(), 0.0], Some((Section::KernelTail, 0))),
        ([-0.25, 0.0], Some((Section::KernelTail, 0))),
        ([0.25, f32::from_bits(1)], Some((Section::KernelTail, 3))),
    ];
    for (tail, due) in cases {
        // Energies of ¼ are not those of a tail of 1.
        assert_eq!(refused_at(&Numbers { tail, ..NUMBERS }, &[]), due, "{tail:?}");
    }
}

#[test]
fn two_gaussians_in_their_ranges() {
    let whole = [0.0, 0.5, 1.0, 1e-12, 2.0, 1e12, 1e-12, 3.0, 1e12];
    let bytes = file(&NUMBERS, &whole);
    let kernel = Kernel::parse(&bytes).unwrap();
    let due = TwoGaussians { weight: [0.0, 0.5, 1.0], tau_near: [1e-12, 2.0, 1e12], tau_far: [1e-12, 3.0, 1e12] };
    assert_eq!(kernel.two_gaussians(), Some(&due));
    assert!(due.to_bytes().eq(floats(&whole)), "as it stands in the file");
    // Shares 0 to 1, variances 10⁻¹² to 10¹², the second one not below the first of its channel.
    for (at, value) in [
        (0, -f32::from_bits(1)),
        (2, 1.0_f32.next_up()),
        (3, 1e-12_f32.next_down()),
        (5, 1e12_f32.next_up()),
        (6, 1e-12_f32.next_down()),
        (7, 2.0_f32.next_down()),
        (8, 1e12_f32.next_down()),
        (8, 1e12_f32.next_up()),
    ] {
        let mut numbers = whole;
        numbers[at] = value;
        assert_eq!(refused_at(&NUMBERS, &numbers), Some((Section::TwoGaussians, at as u64)), "{value} as number {at}");
    }
    // Each far variance goes by the near one of its own channel.
    let narrow_blue = [0.0, 0.5, 1.0, 1.0, 2.0, 1e-12, 1.0, 2.0, 1e-12];
    assert_eq!(refused_at(&NUMBERS, &narrow_blue), None, "blue is narrower than red");
    let mut narrow_red = narrow_blue;
    narrow_red[6] = 1.0_f32.next_down();
    assert_eq!(refused_at(&NUMBERS, &narrow_red), Some((Section::TwoGaussians, 6)), "below the near one");
    let mut equal = whole;
    equal[7] = 2.0;
    assert_eq!(refused_at(&NUMBERS, &equal), None, "of one width");
}

#[test]
fn tail_and_profile_between_nodes() {
    // Four nodes at 2 (k / 3)² mm, and no kernel but the energy.
    let tail = [0.5625, 0.25, 0.0625, 0.5, 0.125, 0.0625, 0.25, 0.125, 0.03125, 0.0, 0.0, 0.0];
    let weights = [0.75, 0.5, 0.25, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let header = KernelHeader { tail_nodes: 4, ..HEADER };
    let (offsets, weights) = (floats(&NUMBERS.offsets), floats(&weights));
    let bytes =
        assemble(&[(b"KERN", &header.to_bytes()), (b"KOFF", &offsets), (b"KWGT", &weights), (b"TAIL", &floats(&tail))]);
    let kernel = Kernel::parse(&bytes).unwrap();
    assert_eq!(kernel.reflectance(), [0.5625, 0.25, 0.0625]);
    assert_eq!(kernel.energy(), kernel.reflectance());
    let close = |found: f32, due: f64| (f64::from(found) - due).abs() <= 2e-5 * due.abs() + 1e-7;
    for d_mm in [0.0_f32, 0.01, 0.1, 0.3, 0.7, 0.95, 1.5, 1.999] {
        let place = 3.0 * (f64::from(d_mm) / 2.0).sqrt();
        let node = place.floor() as usize;
        let edge = |node: usize| 2.0 * (node as f64 / 3.0).powi(2);
        let area = std::f64::consts::PI * (edge(node + 1).powi(2) - edge(node).powi(2));
        let (found_tail, found_rd) = (kernel.tail_at(d_mm), kernel.rd(d_mm));
        for c in 0..3 {
            let [low, high] = [node, node + 1].map(|node| f64::from(tail[3 * node + c]));
            assert!(close(found_tail[c], low + (place - node as f64) * (high - low)), "T({d_mm}): {found_tail:?}");
            assert!(close(found_rd[c], (low - high) / area), "Rd({d_mm}): {found_rd:?}");
        }
    }
    for d_mm in [2.0, 2.5, f32::INFINITY, f32::NAN] {
        assert_eq!([kernel.tail_at(d_mm), kernel.rd(d_mm)], [[0.0; 3]; 2], "{d_mm}");
    }
    assert_eq!(
        [kernel.tail_at(-1.0), kernel.rd(-1.0)],
        [kernel.tail_at(0.0), kernel.rd(0.0)],
        "no distance is below 0"
    );
}

#[test]
fn signs_and_weights_of_several_terms() {
    // Two terms: bits 1 and 5 are green of the first and blue of the second.
    let header = KernelHeader { terms: 2, signs: 0b10_0010, ..HEADER };
    let numbers: Vec<f32> = (0..18_u8).map(|k| f32::from(k) / 1024.0).collect();
    // Sums over both sides: k + 2 (k + 3) + 2 (k + 6) = 5 k + 18 for channel k of a term.
    let energy = |k: f64| ((5.0 * k + 18.0) / 1024.0).powi(2);
    let reflectance = [energy(0.0) + energy(9.0), energy(10.0) - energy(1.0), energy(2.0) - energy(11.0)];
    let tail = [reflectance.map(|value| value.max(0.0) as f32), [0.0; 3]].concat();
    let bytes = assemble(&[
        (b"KERN", &header.to_bytes()),
        (b"KOFF", &floats(&NUMBERS.offsets)),
        (b"KWGT", &floats(&numbers)),
        (b"TAIL", &floats(&tail)),
    ]);
    let error = Kernel::parse(&bytes).err();
    // Blue has less than no energy.
    assert!(matches!(error, Some(ReadError::BadNumber { section: Section::KernelWeights, .. })), "{error:?}");
    let header = KernelHeader { signs: 0b00_0010, ..header };
    let tail =
        [[reflectance[0], reflectance[1], energy(2.0) + energy(11.0)].map(|value| value as f32), [0.0; 3]].concat();
    let bytes = assemble(&[
        (b"KERN", &header.to_bytes()),
        (b"KOFF", &floats(&NUMBERS.offsets)),
        (b"KWGT", &floats(&numbers)),
        (b"TAIL", &floats(&tail)),
    ]);
    let kernel = Kernel::parse(&bytes).unwrap();
    assert_eq!([0, 1, 2].map(|term| kernel.sign(term)), [[1.0, -1.0, 1.0], [1.0; 3], [0.0; 3]]);
    for (term, tap) in (0..2).flat_map(|term| (0..3).map(move |tap| (term, tap))) {
        let first = 3 * (3 * term + tap);
        assert_eq!(kernel.weight(term, tap), [0, 1, 2].map(|c| numbers[first + c]), "{term}, {tap}");
    }
    assert_eq!([kernel.weight(2, 0), kernel.weight(0, 3)], [[0.0; 3]; 2], "there are none");
    for (found, due) in kernel.energy().into_iter().zip([reflectance[0], reflectance[1], energy(2.0) + energy(11.0)]) {
        assert!((f64::from(found) - due).abs() < 1e-6 * due.abs(), "{found} is not {due}");
    }
}
