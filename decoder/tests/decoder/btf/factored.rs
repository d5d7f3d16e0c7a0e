//! Factored BTFs: channels as sums over the columns of the expanded table, and limits of sizes and indices.
#![allow(clippy::cast_possible_truncation, reason = "numbers of tests are small")]

use crate::common::{assemble, floats, rebuilt};
use subsurf_decoder::btf::factored::layout::{CodewordStage, MAX_CHROMA, MAX_LUMA, MAX_STAGES, TuckerShape};
use subsurf_decoder::btf::factored::{ExpandedBtf, ExpansionMemory};
use subsurf_decoder::btf::{BtfHeader, BtfModel, ColourEncoding, Grid, GridCoord, LerpCoord, Material, Texel};
use subsurf_decoder::{FactoredBtf, ReadError, Section};

/// 6 nodes of view and 6 of light.
const GRID: Grid = Grid { n_alpha: 3, n_beta: 2, n_theta: 2, n_phi: 3, ..Grid::PAPER };
/// 11 columns of luma, 3 of each channel of chroma; 16 coefficients.
const SHAPE: TuckerShape = shape(11, 3);
/// As many as there can be.
const LARGEST: TuckerShape = shape(MAX_LUMA, MAX_CHROMA);

/// Two stages of codewords: of all coefficients, and of those of luma.
const fn shape(luma: u8, chroma: u8) -> TuckerShape {
    let mut stages = [CodewordStage { words: 0, first: 0, count: 0 }; MAX_STAGES];
    stages[0] = CodewordStage { words: 4, first: 0, count: 2 + chroma + luma };
    stages[1] = CodewordStage { words: 2, first: 2 + chroma, count: luma };
    TuckerShape { luma, chroma, view_axes: 2, light_axes: 3, stages, count: 2 }
}

/// Value of a step of columns, of ratios.
fn scales(shape: &TuckerShape) -> Vec<f32> {
    (0..shape.columns()).map(|c| 0.001 * (c + 1) as f32).collect()
}

const RATIOS: [f32; 2] = [0.01, 0.03];

/// File of two texels whose entropy-coded sections are any bytes: they are some numbers.
fn file(shape: &TuckerShape, indices: [u8; 4]) -> Vec<u8> {
    let encoding = ColourEncoding::Display { white: 1.0 };
    let header = BtfHeader { model: BtfModel::Factored, encoding, materials: 1, grid: GRID, texel_mm: None };
    let material = Material { name: [0; 24], width: 2, height: 1, levels: 1 };
    let (core_steps, axis_scales) = (vec![0.5; shape.columns()], [0.002, 0.004, 0.5, 0.25, 0.125]);
    let numbers = floats(&[&RATIOS[..], &scales(shape), &core_steps, &axis_scales].concat());
    let tucker: Vec<u8> = shape.to_bytes().chain(numbers).collect();
    let any = |length: u32, seed: u32| -> Vec<u8> {
        (0..length).map(|k| ((k + seed).wrapping_mul(2_654_435_761) >> 24) as u8).collect()
    };
    assemble(&[
        (b"BTFH", &header.to_bytes()),
        (b"MATS", &material.to_bytes()),
        (b"FACT", &tucker),
        (b"AXES", &any(30, 1)),
        (b"CORE", &any(6 * shape.columns() as u32, 50)),
        (b"WORD", &any(10 * shape.coefficients() as u32, 300)),
        (b"INDX", &indices),
    ])
}

/// File whose `FACT` is cut or filled up to a length.
fn with_header_bytes(length: usize) -> Vec<u8> {
    rebuilt(&file(&SHAPE, [0; 4]), |sections| {
        let header = sections.iter_mut().find(|(kind, _)| *kind == Section::TuckerHeader.kind());
        header.expect("the header").1.resize(length, 0);
    })
}

/// Columns between the 16 nodes around coordinates.
fn interpolated(btf: &ExpandedBtf<'_>, columns: usize, coord: &GridCoord) -> Vec<f64> {
    let mut sums = vec![0.0; columns];
    for corner in 0..16_usize {
        let (mut weight, mut node) = (1.0, 0);
        let axes = [(coord.phi, 3), (coord.theta, 2), (coord.alpha, 3), (coord.beta, 2)];
        for (axis, (at, count)) in axes.into_iter().enumerate() {
            let end = corner >> axis & 1;
            weight *= f64::from([1.0 - at.weight, at.weight][end]);
            node = node * count + at.nodes[end] as usize;
        }
        let row = &btf.table()[columns * node..columns * (node + 1)];
        sums.iter_mut().zip(row).for_each(|(sum, step)| *sum += weight * f64::from(*step));
    }
    sums
}

#[test]
fn channels_are_sums_over_columns() {
    let on = |first, second, weight| LerpCoord { nodes: [first, second], weight };
    let coords = [
        GridCoord {
            phi: on(2, 0, 0.25),
            theta: on(0, 1, 0.5),
            alpha: on(1, 2, 0.125),
            beta: on(0, 1, 0.75),
            fade: 0.5,
        },
        GridCoord { phi: on(0, 1, 0.0), theta: on(0, 1, 1.0), alpha: on(0, 1, 1.0), beta: on(0, 1, 0.0), fade: 1.0 },
    ];
    for (shape, lengths) in [(&SHAPE, [36 * 17, 4 * 16 + 2 * 11, 18]), (&LARGEST, [36 * 192, 4 * 162 + 2 * 128, 18])] {
        let bytes = file(shape, [3, 0, 1, 1]);
        let btf = FactoredBtf::parse(&bytes).unwrap();
        assert_eq!((btf.shape(), [btf.table_len(), btf.words_len(), btf.scratch_len()]), (shape, lengths));
        let mut memory = ExpansionMemory::default();
        let expanded = btf.expand_in(&mut memory).unwrap();
        let is_filled = |steps: &[i8]| steps.iter().filter(|step| **step != 0).count() > steps.len() / 2;
        assert!(is_filled(expanded.table()), "a table with something in it");
        for (number, coord) in [0, 1].into_iter().flat_map(|number| coords.map(|coord| (number, coord))) {
            assert_sums(&expanded, shape, Texel::from_number(number), &coord);
        }
    }
}

/// Channels of a texel are what its coefficients and the columns of the table add up to.
fn assert_sums(expanded: &ExpandedBtf<'_>, shape: &TuckerShape, texel: Texel, coord: &GridCoord) {
    let [luma, chroma] = [shape.luma, shape.chroma].map(usize::from);
    let steps = expanded.coefficients(texel).map(f64::from);
    let (of_texel, others) = steps.split_at(shape.coefficients());
    assert!(of_texel.iter().filter(|step| **step != 0.0).count() > of_texel.len() / 2, "{steps:?}");
    assert!(others.iter().all(|step| *step == 0.0), "as many as there are coefficients");
    let (columns, scales) = (interpolated(expanded, shape.columns(), coord), scales(shape));
    // Coefficients of chroma stand before those of luma, columns of luma before those of chroma.
    let products = |first_step: usize, first_column: usize, count: usize| -> [f64; 2] {
        let parts =
            (0..count).map(|k| steps[first_step + k] * f64::from(scales[first_column + k]) * columns[first_column + k]);
        parts.fold([0.0, 0.0], |[sum, most], part| [sum + part, most + part.abs()])
    };
    let [y, most] = products(2 + chroma, 0, luma);
    let [[a, most_a], [b, most_b]] = [luma, luma + chroma].map(|column| products(2, column, chroma));
    let ratios = [0, 1].map(|c| steps[c] * f64::from(RATIOS[c]));
    let due = [y, ratios[0] * y + a, ratios[1] * y + b];
    let room = [most, ratios[0].abs() * most + most_a, ratios[1].abs() * most + most_b];
    let found = expanded.channels(texel, coord);
    for c in 0..3 {
        let error = (f64::from(found[c]) - due[c]).abs();
        assert!(error <= 1e-5 * room[c] + 1e-9, "{texel:?}, channel {c}: {found:?}, not {due:?}");
    }
    let value = expanded.catalog().header().encoding.decode(found).map(|value| value * coord.fade);
    assert_eq!(expanded.eval_at(texel, coord), value, "{texel:?}");
}

#[test]
fn a_header_of_another_length_says_what_it_takes() {
    // Two stages of four bytes after the first eight, and 41 numbers.
    let whole = 16 + 4 * (2 + 2 * SHAPE.columns() + 5);
    for length in 0..whole + 2 {
        let need_bytes = match length {
            0..8 => 8,
            8..12 => 12,
            12..16 => 16,
            _ => whole as u64,
        };
        let have_bytes = length as u64;
        let due = (length != whole).then_some(ReadError::WrongSize {
            section: Section::TuckerHeader,
            need_bytes,
            have_bytes,
        });
        assert_eq!(FactoredBtf::parse(&with_header_bytes(length)).err(), due, "{length} bytes");
    }
}

#[test]
fn sizes_and_indices() {
    let error_of = |shape: &TuckerShape| FactoredBtf::parse(&file(shape, [0; 4])).err();
    let is_field =
        |error: Option<ReadError>| matches!(error, Some(ReadError::BadField { section: Section::TuckerHeader, .. }));
    type Change = fn(&mut TuckerShape, u8);
    let cases: [(&str, Change, &[u8], &[u8]); 7] = [
        ("luma", |s, x| s.luma = x, &[0, 129], &[128]),
        ("chroma", |s, x| s.chroma = x, &[33], &[32]),
        ("view_axes", |s, x| s.view_axes = x, &[0, 7], &[1, 6]),
        ("light_axes", |s, x| s.light_axes = x, &[0, 7], &[1, 6]),
        // Stages that are counted and not there read what follows them.
        ("stages", |s, x| s.count = x, &[0], &[1, 2]),
        ("coefficients of a stage", |s, x| s.stages[0].count = x, &[0, 17], &[1, 16]),
        ("first coefficient of a stage", |s, x| s.stages[1].first = x, &[6, 255], &[0, 5]),
    ];
    for (name, change, refused, allowed) in cases {
        let with = |value: u8| {
            let mut shape = SHAPE;
            change(&mut shape, value);
            error_of(&shape)
        };
        for &value in refused {
            let error = with(value);
            assert!(is_field(error), "{name} {value}: {error:?}");
        }
        for &value in allowed {
            let error = with(value);
            assert!(!is_field(error), "{name} {value}: {error:?}");
        }
    }
    // Four codewords of the first stage, two of the second.
    for (indices, refused) in [
        ([3, 1, 3, 1], None),
        ([4, 0, 0, 0], Some((0, 4, 4))),
        ([0, 0, 0, 2], Some((3, 2, 2))),
        ([3, 1, 255, 0], Some((2, 255, 4))),
    ] {
        let bytes = file(&SHAPE, indices);
        let first = bytes.len() as u64 - 4;
        let due = refused.map(|(at, index, len)| ReadError::IndexOutOfRange {
            section: Section::TexelIndices,
            offset: first + at,
            index,
            len,
        });
        assert_eq!(FactoredBtf::parse(&bytes).err(), due, "{indices:?}");
    }
}
