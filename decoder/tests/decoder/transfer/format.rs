//! Transfer files: the reader against the words of `FORMAT.md`, section 7, and hostile ones.

use crate::common::damage::Sound;
use crate::common::{crc32, seal_all};
use proptest::prelude::*;
use subsurf_decoder::container::bytes::F32Le;
use subsurf_decoder::transfer::LightWeights;
use subsurf_decoder::{Content, Family, File, Kernel, ReadError, Section, Transfer};

const SECTIONS: usize = 8;

fn seal(file: &mut [u8]) {
    seal_all(file, SECTIONS);
}

fn floats(values: &[f32]) -> impl Iterator<Item = u8> {
    values.iter().flat_map(|value| value.to_le_bytes())
}

/// The 432 bytes of section 7.3, from literals: nothing here uses the crate's own layout.
#[rustfmt::skip]
fn example() -> Vec<u8> {
    let mut file = crate::common::begin(0x1B0, [
        (b"XFER", 220, 58), (b"XDIR", 280, 48), (b"XAXS", 328, 8), (b"XRNG", 336, 48), (b"XMEA", 384, 8), (b"XBAS", 392, 8),
        (b"XVTX", 400, 6), (b"TAIL", 408, 24),
    ]);
    file.extend([
        0x01, 0x01, 0x04, 0x00,                          // colour space, 1 channel, L
        0x02, 0x00, 0x02, 0x00,                          // M, m
        0x03, 0x00, 0x00, 0x00,                          // N
    ]);
    let positions: Vec<u8> = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]).collect();
    let triangles: Vec<u8> = [0_u32, 1, 2].iter().flat_map(|k| k.to_le_bytes()).collect();
    file.extend(crc32(&positions).to_le_bytes());
    file.extend(crc32(&triangles).to_le_bytes());
    file.extend(floats(&[2.0, 1.5, 0.5, 1.0, 1.0]));     // radius, eta, scale
    file.extend([3, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    file.extend([0x02, 0x00, 0, 0]);                     // axes, fill
    file.extend(floats(&[1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]));
    file.extend([0x01, 0x00, 0x00, 0x01, 0x01, 0x01, 0x02, 0xFF]);
    file.extend(floats(&[0.0, 1.0 / 1024.0, -0.25, 0.125, 0.0, 0.125]));
    file.extend(floats(&[0.5, 0.0, 0.0, 0.0, 0.0, 0.0]));
    file.extend([0x00, 0x04, 0x00, 0x02, 0x00, 0x00, 0x00, 0x00]);
    file.extend([0x01, 0x00, 0xFF, 0x04, 0x00, 0x00, 0x00, 0x00]);
    file.extend([0x00, 0x1C, 0x00, 0x00, 0x01, 0x00]);
    file.extend([0, 0]);                                 // fill
    file.extend(floats(&[49.0 / 64.0, 25.0 / 64.0, 0.25, 0.0, 0.0, 0.0]));
    seal(&mut file);
    file
}

/// Exitance of the first vertices under given weights of the lights.
fn exitance(file: &Transfer<'_>, weights: &[f32], vertices: usize) -> Vec<f32> {
    let mut table = vec![0.0; file.header().table_len()];
    file.light_table(weights, &mut table);
    let mut out = vec![f32::NAN; vertices * usize::from(file.header().channels)];
    file.exitance(&table, 0, &mut out);
    out
}

/// Uses everything a parsed file offers and checks the bounds that hold for any file.
fn exercise(file: &Transfer<'_>) {
    let header = file.header();
    let lights: usize = header.lights.into();
    assert_eq!(file.lights().len(), 3 * lights, "a direction for each light");
    let vertices = usize::try_from(header.vertices).unwrap();
    let mut buffer = vec![0.0; LightWeights::buffer_len(lights)];
    let mut weights = vec![1.0; lights];
    if let Some(between) = LightWeights::new(file.lights(), &mut buffer) {
        for towards in [[0.0, 0.6, 0.8], [-1.0, 0.0, 0.0]] {
            between.at(towards, &mut weights);
            let sum: f32 = weights.iter().sum();
            assert!((sum - 1.0).abs() < 1e-3, "{sum}");
        }
    }
    let found = exitance(file, &weights, vertices + 1);
    assert!(found.iter().all(|q| q.is_finite()), "{found:?}");
    assert!(found[vertices * usize::from(header.channels)..].iter().all(|q| *q == 0.0), "nothing beyond the mesh");
    // Weights, tables and room that are too short or too long do no harm.
    for length in [0, 1, 5] {
        file.light_table(&weights[..length.min(lights)], &mut vec![0.0; length]);
        file.exitance(&vec![1.0; length], 1, &mut vec![0.0; length]);
        assert!(LightWeights::new(file.lights(), &mut vec![0.0; length]).is_none(), "no room");
    }
    file.exitance(&[], usize::MAX, &mut [0.0; 9]);
    let mut beyond = [1.0; 3];
    file.exitance(&vec![1.0; file.header().table_len()], 1 << (usize::BITS - 1), &mut beyond);
    assert_eq!(beyond, [0.0; 3], "a number of a vertex whose place in bytes is beyond what numbers hold");
}

#[test]
fn reads_the_example() {
    let bytes = example();
    assert_eq!(bytes, include_bytes!("../../../../tests/vectors/transfer_example.subsurf"));
    let Content::Transfer(file) = File::parse(&bytes).unwrap().content() else { panic!("the example is a transfer") };
    let header = file.header();
    assert_eq!((header.channels, header.lights, header.clusters, header.vertices), (1, 4, 2, 3));
    assert_eq!((header.components(), header.record_bytes(), header.table_len(), header.axes), (2, 2, 6, 2));
    assert_eq!((header.radius_mm, header.eta, header.scale[0]), (2.0, 1.5, 0.5));
    let expected = [[0.4375, 0.375, 0.25], [1.0, 0.25, 0.25], [1.4375, 0.625, 0.5], [-0.125, 0.5, 0.25]];
    for (light, expected) in expected.into_iter().enumerate() {
        let mut weights = [0.0; 4];
        weights[light] = 1.0;
        assert_eq!(exitance(&file, &weights, 3), expected, "light {light}");
    }
    assert_eq!(exitance(&file, &[0.5, 0.5, 0.0, 0.0], 1), [0.71875], "weights act once for all vertices");
    exercise(&file);
}

/// A spiral of directions, even over the sphere.
#[allow(clippy::cast_possible_truncation, reason = "rounded, as files have them")]
fn spiral(count: usize) -> Vec<u8> {
    let at = |k: usize| {
        let y = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
        let (radius, turn) = ((1.0 - y * y).sqrt(), k as f64 * 2.399_963_229_728_653);
        [turn.cos() * radius, y, turn.sin() * radius].map(|x| x as f32)
    };
    (0..count).flat_map(at).flat_map(f32::to_le_bytes).collect()
}

#[test]
fn weights_go_through_the_lights_and_are_smooth_between() {
    let count = 200;
    let bytes = spiral(count);
    let lights = F32Le::new(&bytes);
    let mut buffer = vec![0.0; LightWeights::buffer_len(count)];
    let between = LightWeights::new(lights, &mut buffer).unwrap();
    let light = |k: usize| [0, 1, 2].map(|axis| lights.get(3 * k + axis).unwrap());
    let mut weights = vec![0.0; count];
    between.at(light(17), &mut weights);
    for (k, weight) in weights.iter().enumerate() {
        assert!((weight - f32::from(u8::from(k == 17))).abs() < 1e-3, "{k}: {weight}");
    }
    // Functions of the direction that bend slowly come back; a constant does exactly.
    let smooth = |[x, y, z]: [f32; 3]| 0.3 + x - 0.5 * y * z + 0.2 * x * x * z;
    for towards in [[0.6, 0.0, 0.8], [0.0, 0.0, -1.0], [0.48, 0.6, -0.64], [0.0, 1.0, 0.0]] {
        between.at(towards, &mut weights);
        let found: f32 = (0..count).map(|k| weights[k] * smooth(light(k))).sum();
        assert!((found - smooth(towards)).abs() < 5e-4, "{towards:?}: {found} of {}", smooth(towards));
        assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-4, "a constant");
    }
    let twice = [&bytes[..], &bytes[..12]].concat();
    let mut buffer = vec![0.0; LightWeights::buffer_len(count + 1)];
    assert!(LightWeights::new(F32Le::new(&twice), &mut buffer).is_none(), "a light that is there twice");
}

#[test]
fn other_families_are_told_apart() {
    let (transfer, bssrdf) = (example(), crate::common::example());
    let other = |found, expected| ReadError::OtherFamily { found, expected };
    assert_eq!(Kernel::parse(&transfer).unwrap_err(), other(Family::Transfer, Family::Kernel));
    let error = Transfer::parse(&bssrdf).unwrap_err();
    assert_eq!(error, other(Family::Bssrdf, Family::Transfer));
    assert_eq!(error.to_string(), "a BSSRDF, not a transfer");
}

#[test]
fn broken_fields_are_refused_for_what_is_broken() {
    let error = |at: usize, value: &[u8]| {
        let mut bytes = example();
        bytes[at..at + value.len()].copy_from_slice(value);
        seal(&mut bytes);
        Transfer::parse(&bytes).unwrap_err()
    };
    // Channels, lights, clusters, vertices, bits: none first, after none, too many; axes.
    let fields: [(usize, &[u8], u32); 9] = [
        (221, &[2], 2),
        (222, &[3], 3),
        (224, &[0], 0),
        (228, &[0], 0),
        (260, &[0], 0),
        (263, &[1], 1),
        (260, &[13], 13),
        (276, &[0], 0),
        (277, &[2], 514),
    ];
    for (at, value, expected) in fields {
        let found = error(at, value);
        assert!(
            matches!(found, ReadError::BadField { section: Section::TransferHeader, value, .. } if value == expected),
            "{at}: {found}"
        );
    }
    assert!(matches!(error(260, &[12; 16]), ReadError::BadField { value: 12, .. }), "192 bits");
    let numbers = [
        (244, 0.5_f32, Section::TransferHeader),
        (248, 0.0, Section::TransferHeader),
        (280, 0.5, Section::Lights),
        (280, 1.1, Section::Lights),
        (336, f32::NAN, Section::ClusterRanges),
        (340, -0.5, Section::ClusterRanges),
        (408, 1.5, Section::KernelTail),
    ];
    for (at, value, expected) in numbers {
        let found = error(at, &value.to_le_bytes());
        assert!(matches!(found, ReadError::BadNumber { section, .. } if section == expected), "{at}: {found}");
    }
    let found = error(402, &[2]);
    assert!(matches!(found, ReadError::IndexOutOfRange { offset: 402, index: 2, len: 2, .. }), "{found}");
    assert!(
        matches!(error(260, &[3, 8]), ReadError::WrongSize { section: Section::VertexCodes, .. }),
        "longer records"
    );
}

fn sound() -> Sound {
    let open = |bytes: &[u8], crc| Transfer::parse_with(bytes, crc).map(|transfer| exercise(&transfer));
    Sound { file: example(), sections: SECTIONS, open }
}

#[test]
fn cut_at_every_length() {
    sound().cut_at_every_length();
}

#[test]
fn every_bit_of_every_byte_flipped() {
    // Two bytes of fill behind the header and two behind the codes are covered by nothing.
    sound().flip_every_bit(&[278..280, 406..408]);
}

proptest! {
    #[test]
    fn any_sections_behind_a_sound_start(bytes in proptest::collection::vec(any::<u8>(), 220..600)) {
        sound().begin(bytes);
    }

    #[test]
    fn any_damage_with_valid_crcs(changes in proptest::collection::vec((8_usize..432, any::<u8>()), 1..6)) {
        sound().change(&changes);
    }
}
