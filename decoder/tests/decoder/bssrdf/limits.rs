//! Limits of BSSRDFs: what is allowed up to the last value, and refused from the next one on, by field, size, value and index.
#![allow(clippy::cast_possible_truncation, reason = "numbers of tests are small")]

use crate::common::{HEADER, bssrdf, floats};
use subsurf_decoder::bssrdf::{BssrdfHeader, Coding};
use subsurf_decoder::{Bssrdf, ReadError, Section};

/// First byte of the header section of a file that has no other one.
const HEADER_AT: u64 = 24 + 24 + 4;

/// Error of a file that ends with its header: that of the header, or of the section that comes next.
fn refusal(header: BssrdfHeader) -> ReadError {
    Bssrdf::parse(&bssrdf(header, &[])).unwrap_err()
}

#[test]
fn fields_of_the_header() {
    type Change = fn(&mut BssrdfHeader, u32);
    let cases: [(&str, Change, &[u32], &[u32]); 8] = [
        ("model", |h, x| h.model = x as u8, &[0, 4, 6, 255], &[3, 5]),
        ("width", |h, x| h.width = x, &[0, 65_536], &[1, 65_535]),
        ("height", |h, x| h.height = x, &[0, 65_536], &[1, 65_535]),
        ("window_radius", |h, x| h.window_radius = x as u16, &[1_024], &[0, 1_023]),
        ("samples", |h, x| h.samples = x as u16, &[0, 1, 4_097], &[2, 4_096]),
        ("base_materials", |h, x| h.base_materials = x, &[0, 257], &[1, 256]),
        ("base_materials of one per pixel", |h, x| (h.model, h.base_materials) = (1, x), &[0, 65_537], &[1, 65_536]),
        ("base_materials of none", |h, x| (h.model, h.base_materials) = (0, x), &[1, 256], &[0]),
    ];
    for (name, change, refused, allowed) in cases {
        let with = |value: u32| {
            let mut header = HEADER;
            change(&mut header, value);
            header
        };
        for &value in refused {
            let error = refusal(with(value));
            // A file of per-pixel profiles has no base materials, so that the two of the example are what is wrong.
            let value = if name == "model" && value == 0 { 2 } else { value };
            let is_due = matches!(error, ReadError::BadField { section: Section::BssrdfHeader, value: found, .. } if found == value);
            assert!(is_due, "{name} {value}: {error}");
        }
        for &value in allowed {
            let error = refusal(with(value));
            assert!(matches!(error, ReadError::Missing { .. }), "{name} {value}: {error}");
        }
    }
    let (palette, small) = (Coding::Palette, Coding::SmallRatios);
    for (model, coding) in [(1, palette), (3, palette), (5, small), (0, small)] {
        let base_materials = if model == 0 { 0 } else { 2 };
        let error = refusal(BssrdfHeader { model, coding, base_materials, ..HEADER });
        let offset = HEADER_AT + 3;
        let due = ReadError::BadField { section: Section::BssrdfHeader, offset, value: coding.code().into() };
        assert_eq!(error, due, "{coding:?} is for K = 2");
    }
}

#[test]
fn lengths_and_refractive_index() {
    type Change = fn(&mut BssrdfHeader, f32);
    let cases: [(u64, Change, [f32; 2]); 3] = [
        (20, |h, x| h.pitch_mm = x, [1e-6, 1e6]),
        (24, |h, x| h.r_max_mm = x, [1e-6, 1e6]),
        (28, |h, x| h.eta = x, [1.0, 4.0]),
    ];
    for (at, change, [min, max]) in cases {
        let error_of = |value: f32| {
            let mut header = HEADER;
            change(&mut header, value);
            refusal(header)
        };
        for value in [min, max] {
            assert_eq!(error_of(value), ReadError::Missing { section: Section::BaseProfiles }, "{value} at {at}");
        }
        for value in [min.next_down(), max.next_up()] {
            let due = ReadError::BadNumber { section: Section::BssrdfHeader, offset: HEADER_AT + at, value, min, max };
            assert_eq!(error_of(value), due);
        }
    }
}

#[test]
fn sizes_of_sections_follow_from_the_header() {
    use Section::{BaseIndices, BaseProfiles, Codes, HalfProfiles, LocalProfiles, MixtureRatios, SmallRatios};
    // N = 15, S = 7, M = 11.
    let header = BssrdfHeader { width: 3, height: 5, samples: 7, base_materials: 11, ..HEADER };
    let cases: [(u8, Section, u64); 14] = [
        (2, BaseProfiles, 924),
        (2, HalfProfiles, 462),
        (2, MixtureRatios, 60),
        (2, BaseIndices, 30),
        (2, SmallRatios, 15),
        (2, Codes, 30),
        (1, BaseIndices, 15),
        (3, MixtureRatios, 180),
        (3, BaseIndices, 45),
        (5, MixtureRatios, 300),
        (5, BaseIndices, 75),
        (0, LocalProfiles, 1_260),
        (2, Section::Pairs, 0),
        (2, Section::SeparableBasis, 0),
    ];
    for (model, section, bytes) in cases {
        assert_eq!(BssrdfHeader { model, ..header }.section_bytes(section), bytes, "{section} of model {model}");
    }
    let many = |base_materials| BssrdfHeader { model: 1, base_materials, ..header };
    assert_eq!([256, 257].map(|m| many(m).section_bytes(BaseIndices)), [15, 30], "two bytes where one does not do");
}

#[test]
fn lengths_of_palettes() {
    let (ratio_and_pair, profiles) = ([0, 0, 0, 0], floats(&[0.0; 12]));
    let header = BssrdfHeader { coding: Coding::Palette, ..HEADER };
    let error_of = |length: usize| {
        let pairs = vec![1; length];
        let sections: [(&[u8; 4], &[u8]); 3] = [(b"PROF", &profiles), (b"CODE", &ratio_and_pair), (b"PAIR", &pairs)];
        Bssrdf::parse(&bssrdf(header, &sections)).err()
    };
    for length in [2, 4, 4_096] {
        assert_eq!(error_of(length), None, "{length} bytes");
    }
    for length in [0, 1, 3, 4_095, 4_097, 4_098] {
        let due = ReadError::WrongSize { section: Section::Pairs, need_bytes: 4_096, have_bytes: length as u64 };
        assert_eq!(error_of(length), Some(due));
    }
}

/// Profiles of the example with other values, in single or half precision.
fn with_profiles(kind: &[u8; 4], profiles: &[u8]) -> Option<ReadError> {
    let sections: [(&[u8; 4], &[u8]); 3] =
        [(kind, profiles), (b"MIXR", &floats(&[1.0, 0.25])), (b"BIDX", &[0, 1, 1, 0])];
    Bssrdf::parse(&bssrdf(HEADER, &sections)).err()
}

#[test]
fn logarithms() {
    let first = 24 + 24 * 4 + 4 + HEADER.to_bytes().len() as u64;
    let most = 87.0_f32;
    for value in [most, -most, 0.0, -0.0, f32::MIN_POSITIVE] {
        assert_eq!(with_profiles(b"PROF", &floats(&[value; 12])), None, "{value}");
    }
    for value in [most.next_up(), (-most).next_down(), f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
        for at in [0, 5, 11] {
            // The others are as large as they may be.
            let mut profiles = [most; 12];
            profiles[at] = value;
            let offset = first + 4 * at as u64;
            let due = ReadError::BadNumber { section: Section::BaseProfiles, offset, value, min: -87.0, max: 87.0 };
            assert_eq!(with_profiles(b"PROF", &floats(&profiles)), Some(due));
        }
    }
    // 87 in half precision, and the next above it; infinity and NaN come after all numbers.
    for (bits, is_allowed) in
        [(0x5570_u16, true), (0xD570, true), (0x5571, false), (0xD571, false), (0x7C00, false), (0xFE00, false)]
    {
        for at in [0, 7, 11] {
            let mut profiles = [0x5570_u16; 12];
            profiles[at] = bits;
            let bytes: Vec<u8> = profiles.iter().flat_map(|bits| bits.to_le_bytes()).collect();
            match with_profiles(b"PRFH", &bytes) {
                None => assert!(is_allowed, "{bits:x}"),
                Some(ReadError::BadNumber {
                    section: Section::HalfProfiles, offset, min: -87.0, max: 87.0, ..
                }) => {
                    assert!(!is_allowed && offset == first + 2 * at as u64, "{bits:x} at {at}: byte {offset}");
                }
                Some(error) => panic!("{bits:x}: {error}"),
            }
        }
    }
}

#[test]
fn a_wrong_value_is_found_wherever_it_stands() {
    // Checked in blocks, and what is left: 3 × 13 ratios.
    let header = BssrdfHeader { width: 13, height: 3, ..HEADER };
    let profiles = floats(&[0.0; 12]);
    for at in 0..39 {
        let mut ratios = [0.5_f32; 39];
        ratios[at] = 1.0_f32.next_up();
        let (ratios, indices) = (floats(&ratios), [0; 78]);
        let sections: [(&[u8; 4], &[u8]); 3] = [(b"PROF", &profiles), (b"MIXR", &ratios), (b"BIDX", &indices)];
        let error = Bssrdf::parse(&bssrdf(header, &sections)).unwrap_err();
        let first = 124 + header.to_bytes().len() as u64 + 48;
        assert!(
            matches!(error, ReadError::BadNumber { offset, .. } if offset == first + 4 * at as u64),
            "{at}: {error}"
        );
    }
}

#[test]
fn ratios_of_two() {
    for (value, is_allowed) in
        [(0.0_f32, true), (1.0, true), (-0.0, false), (1.0_f32.next_up(), false), (-f32::MIN_POSITIVE, false)]
    {
        let profiles = floats(&[0.0; 12]);
        let ratios = floats(&[0.5, value]);
        let sections: [(&[u8; 4], &[u8]); 3] = [(b"PROF", &profiles), (b"MIXR", &ratios), (b"BIDX", &[0; 4])];
        let error = Bssrdf::parse(&bssrdf(HEADER, &sections)).err();
        assert_eq!(error.is_none(), is_allowed, "{value:?}: {error:?}");
    }
}

#[test]
fn sums_of_several_ratios() {
    let step = 1.0_f32 / 1024.0;
    // Shape [K][N]: both pixels have ¼ and ½ of two materials, the third ratio is the last two numbers.
    let error_of = |third: [f32; 2]| {
        let (profiles, ratios) = (floats(&[0.0; 12]), floats(&[0.25, 0.25, 0.5, 0.5, third[0], third[1]]));
        let sections: [(&[u8; 4], &[u8]); 3] = [(b"PROF", &profiles), (b"MIXR", &ratios), (b"BIDX", &[0; 6])];
        Bssrdf::parse(&bssrdf(BssrdfHeader { model: 3, ..HEADER }, &sections)).err()
    };
    for third in [0.25, 0.25 + step, 0.25 - step] {
        assert_eq!(error_of([0.25, third]), None, "{third}");
    }
    let ulp = f32::EPSILON;
    for third in [0.25 + step + ulp, 0.25 - step - ulp] {
        let error = error_of([0.25, third]).unwrap();
        let ReadError::BadNumber { section: Section::MixtureRatios, offset, value, min, max } = error else {
            panic!("{error}")
        };
        // The second pixel's ratios begin 4 bytes after those of the first.
        assert_eq!(offset, 124 + HEADER.to_bytes().len() as u64 + 48 + 4, "the pixel");
        assert_eq!((value, min, max), (0.75 + third, 1.0 - step, 1.0 + step), "its sum");
    }
}

#[test]
fn indices_of_base_materials_and_pairs() {
    let first = 124 + HEADER.to_bytes().len() as u64 + 48;
    let (profiles, ratios) = (floats(&[0.0; 12]), floats(&[1.0, 0.25]));
    // One base material per pixel, two, and a palette of three pairs.
    for index in [0, 1, 2, 255] {
        let due = |offset, len| {
            let section = Section::BaseIndices;
            (u32::from(index) >= len).then_some(ReadError::IndexOutOfRange {
                section,
                offset,
                index: index.into(),
                len,
            })
        };
        let sections: [(&[u8; 4], &[u8]); 2] = [(b"PROF", &profiles), (b"BIDX", &[1, index])];
        let one = Bssrdf::parse(&bssrdf(BssrdfHeader { model: 1, ..HEADER }, &sections)).err();
        assert_eq!(one, due(first - 24 + 1, 2));
        let sections: [(&[u8; 4], &[u8]); 3] = [(b"PROF", &profiles), (b"MIXR", &ratios), (b"BIDX", &[1, 1, 0, index])];
        assert_eq!(Bssrdf::parse(&bssrdf(HEADER, &sections)).err(), due(first + 8 + 3, 2));
    }
    for (code, is_allowed) in [(2_u16, true), (2 + 31 * 2_048, true), (3, false), (2_047 + 2_048, false)] {
        let codes = [[0, 0], code.to_le_bytes()].concat();
        let sections: [(&[u8; 4], &[u8]); 3] =
            [(b"PROF", &profiles), (b"CODE", &codes), (b"PAIR", &[0, 1, 1, 0, 1, 1])];
        let error = Bssrdf::parse(&bssrdf(BssrdfHeader { coding: Coding::Palette, ..HEADER }, &sections)).err();
        let index = u32::from(code % 2_048);
        let due = ReadError::IndexOutOfRange { section: Section::Codes, offset: first + 2, index, len: 3 };
        assert_eq!(error, (!is_allowed).then_some(due), "{code}");
    }
    // 257 base materials take two bytes.
    let profiles = [0; 257 * 12];
    for (index, is_allowed) in [(256_u16, true), (257, false)] {
        let header = BssrdfHeader { model: 1, base_materials: 257, ..HEADER };
        let indices = [[7, 0], index.to_le_bytes()].concat();
        let error = Bssrdf::parse(&bssrdf(header, &[(b"PRFH", &profiles), (b"BIDX", &indices)])).err();
        let offset = first - 24 - 48 + 257 * 12 + 2;
        let due = ReadError::IndexOutOfRange { section: Section::BaseIndices, offset, index: 257, len: 257 };
        assert_eq!(error, (!is_allowed).then_some(due), "{index}");
    }
}
