//! Factored BTFs: channels as sums over the columns of the expanded table, and limits of sizes and indices.
#![allow(clippy::cast_possible_truncation, reason = "numbers of tests are small")]

mod common;

use common::{assemble, floats};
use subsurf_decoder::btf::factored::layout::{CodewordStage, MAX_STAGES, TuckerShape};
use subsurf_decoder::btf::factored::{ExpandedBtf, ExpansionMemory};
use subsurf_decoder::btf::{BtfHeader, BtfModel, ColourEncoding, Grid, GridCoord, LerpCoord, Material, Texel};
use subsurf_decoder::{FactoredBtf, ReadError, Section};

/// 6 nodes of view and 6 of light.
const GRID: Grid = Grid { n_alpha: 3, n_beta: 2, n_theta: 2, n_phi: 3, ..Grid::PAPER };
/// 11 columns of luma, 3 of each channel of chroma; 16 coefficients.
const SHAPE: TuckerShape = shape();
const COLUMNS: usize = 17;

const fn shape() -> TuckerShape {
    let mut stages = [CodewordStage { words: 0, first: 0, count: 0 }; MAX_STAGES];
    stages[0] = CodewordStage { words: 4, first: 0, count: 16 };
    stages[1] = CodewordStage { words: 2, first: 5, count: 11 };
    TuckerShape { luma: 11, chroma: 3, view_axes: 2, light_axes: 3, stages, count: 2 }
}

/// Value of a step of columns, of ratios.
fn scales() -> Vec<f32> {
    (0..COLUMNS).map(|c| 0.001 * (c + 1) as f32).collect()
}

const RATIOS: [f32; 2] = [0.01, 0.03];

/// File of two texels whose entropy-coded sections are any bytes: they are some numbers.
fn file(shape: &TuckerShape, indices: [u8; 4]) -> Vec<u8> {
    let encoding = ColourEncoding::Display { white: 1.0 };
    let header = BtfHeader { model: BtfModel::Factored, encoding, materials: 1, grid: GRID, texel_mm: None };
    let material = Material { name: [0; 24], width: 2, height: 1, levels: 1 };
    let (core_steps, axis_scales) = ([0.5; COLUMNS], [0.002, 0.004, 0.5, 0.25, 0.125]);
    let numbers = floats(&[&RATIOS[..], &scales(), &core_steps, &axis_scales].concat());
    let tucker: Vec<u8> = shape.to_bytes().chain(numbers).collect();
    let any = |length: u32, seed: u32| -> Vec<u8> {
        (0..length).map(|k| ((k + seed).wrapping_mul(2_654_435_761) >> 24) as u8).collect()
    };
    assemble(&[
        (b"BTFH", &header.to_bytes()),
        (b"MATS", &material.to_bytes()),
        (b"FACT", &tucker),
        (b"AXES", &any(30, 1)),
        (b"CORE", &any(90, 50)),
        (b"WORD", &any(150, 300)),
        (b"INDX", &indices),
    ])
}

/// Columns between the 16 nodes around coordinates.
fn interpolated(btf: &ExpandedBtf<'_>, coord: &GridCoord) -> [f64; COLUMNS] {
    let mut sums = [0.0; COLUMNS];
    for corner in 0..16_usize {
        let (mut weight, mut node) = (1.0, 0);
        let axes = [(coord.phi, 3), (coord.theta, 2), (coord.alpha, 3), (coord.beta, 2)];
        for (axis, (at, count)) in axes.into_iter().enumerate() {
            let end = corner >> axis & 1;
            weight *= f64::from([1.0 - at.weight, at.weight][end]);
            node = node * count + at.nodes[end] as usize;
        }
        let row = &btf.table()[COLUMNS * node..COLUMNS * (node + 1)];
        sums.iter_mut().zip(row).for_each(|(sum, step)| *sum += weight * f64::from(*step));
    }
    sums
}

#[test]
fn channels_are_sums_over_columns() {
    let bytes = file(&SHAPE, [3, 0, 1, 1]);
    let btf = FactoredBtf::parse(&bytes).unwrap();
    assert_eq!((btf.shape(), btf.table_len(), btf.words_len(), btf.scratch_len()), (&SHAPE, 612, 86, 18));
    let mut memory = ExpansionMemory::default();
    let expanded = btf.expand_in(&mut memory).unwrap();
    assert!(expanded.table().iter().filter(|step| **step != 0).count() > 300, "a table with something in it");
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
    for (number, coord) in [0, 1].into_iter().flat_map(|number| coords.map(|coord| (number, coord))) {
        let texel = Texel::from_number(number);
        let steps = expanded.coefficients(texel).map(f64::from);
        assert!(steps[..16].iter().filter(|step| **step != 0.0).count() > 8, "{steps:?}");
        assert!(steps[16..].iter().all(|step| *step == 0.0), "as many as there are coefficients");
        let (columns, scales) = (interpolated(&expanded, &coord), scales());
        // Coefficients of chroma stand before those of luma, columns of luma before those of chroma.
        let products = |first_step: usize, first_column: usize, count: usize| -> [f64; 2] {
            let parts = (0..count)
                .map(|k| steps[first_step + k] * f64::from(scales[first_column + k]) * columns[first_column + k]);
            parts.fold([0.0, 0.0], |[sum, most], part| [sum + part, most + part.abs()])
        };
        let ([y, most], [a, most_a], [b, most_b]) = (products(5, 0, 11), products(2, 11, 3), products(2, 14, 3));
        let ratios = [0, 1].map(|c| steps[c] * f64::from(RATIOS[c]));
        let due = [y, ratios[0] * y + a, ratios[1] * y + b];
        let room = [most, ratios[0].abs() * most + most_a, ratios[1].abs() * most + most_b];
        let found = expanded.channels(texel, &coord);
        for c in 0..3 {
            let error = (f64::from(found[c]) - due[c]).abs();
            assert!(error <= 1e-5 * room[c] + 1e-9, "texel {number}, channel {c}: {found:?}, not {due:?}");
        }
        let value = expanded.catalog().header().encoding.decode(found).map(|value| value * coord.fade);
        assert_eq!(expanded.eval_at(texel, &coord), value);
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
