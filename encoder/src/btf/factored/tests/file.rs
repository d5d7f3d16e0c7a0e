//! Files of random factors, read back and held against the formulas of `FORMAT.md`.

use nalgebra::DMatrix;
use subsurf_decoder::btf::NAME_BYTES;
use subsurf_decoder::btf::factored::ExpansionMemory;
use subsurf_decoder::btf::{
    BtfHeader, BtfModel, ColourEncoding, Evaluate, ExpandedBtf, FactoredBtf, Grid, GridCoord, LerpCoord, Material,
};
use subsurf_decoder::container::Crc;
use subsurf_decoder::{Family, ReadError, Section};

use crate::btf::factored::angles::Tucker;
use crate::btf::factored::texels::Quantised;
use crate::btf::factored::write::Contents;
use crate::synthetic::unit;

const GRID: Grid = Grid { n_alpha: 3, n_beta: 4, n_theta: 3, n_phi: 5, ..Grid::PAPER };
const LUMA: usize = 3;
const CHROMA: usize = 2;
const COLUMNS: usize = LUMA + 2 * CHROMA;
const TEXELS: usize = 12;
const FACTORS: [f32; COLUMNS] = [2e-5, 1e-5, 3e-5, 1e-5, 2e-5, 1e-5, 3e-5];
const RATIO_STEPS: [f32; 2] = [0.01, 0.02];

/// Factors whose tables reach some 100 steps, so that none is cut.
fn random() -> (Tucker, Quantised) {
    let mut number = 0;
    let mut next = |from: f32, to: f32| {
        number += 1;
        from + (to - from) * unit(number)
    };
    let mut axis = |nodes: usize, count: usize| -> (Vec<i8>, Vec<f32>) {
        let bytes = (0..nodes * count).map(|_| next(-127.0, 127.0) as i8).collect();
        (bytes, (0..count).map(|_| next(0.5, 1.0) / 127.0).collect())
    };
    let (views, lights) = (axis(GRID.view_nodes(), 3), axis(GRID.light_nodes(), 2));
    let core = (0..COLUMNS).map(|_| (0..6).map(|_| next(-9.0, 9.0) as i32).collect()).collect();
    let tucker = Tucker {
        axes: [views.0, lights.0],
        scales: [views.1, lights.1],
        core,
        core_steps: (0..COLUMNS).map(|_| next(3.0, 5.0)).collect(),
        steps: vec![1.0; COLUMNS],
    };
    let sizes = [(2 + CHROMA + LUMA, 5), (2 + CHROMA + 1, 3)];
    let words: Vec<DMatrix<f32>> = sizes
        .iter()
        .map(|(count, words)| DMatrix::from_fn(*count, *words, |_, _| next(-400.0, 400.0).round()))
        .collect();
    let indices = (0..TEXELS).flat_map(|texel| [(texel % 5) as u8, (texel % 3) as u8]).collect();
    (tucker, Quantised { words, indices })
}

fn file(tone: ColourEncoding) -> Vec<u8> {
    let (tucker, texels) = random();
    Contents {
        header: BtfHeader { model: BtfModel::Factored, encoding: tone, materials: 1, grid: GRID, texel_mm: None },
        materials: &[Material { name: [b'x'; NAME_BYTES], width: 4, height: 3, levels: 1 }],
        components: [LUMA, CHROMA],
        tucker: &tucker,
        texels: &texels,
        ratio_steps: RATIO_STEPS,
        factors: &FACTORS,
    }
    .to_bytes()
}

const DISPLAY: ColourEncoding = ColourEncoding::Display { white: 1.0 };

/// Calls with the file expanded.
fn open<T>(bytes: &[u8], with: impl FnOnce(&ExpandedBtf<'_>) -> T) -> T {
    let file = FactoredBtf::parse(bytes).unwrap();
    let mut memory = ExpansionMemory::default();
    with(&file.expand_in(&mut memory).unwrap())
}

/// X[v][l] = Σ_ij A_i[v] G[i][j] B_j[l], summed in double precision.
fn entry(tucker: &Tucker, column: usize, view: usize, light: usize) -> f64 {
    let ([view_axes, light_axes], [view_scales, light_scales]) = (&tucker.axes, &tucker.scales);
    let of = |axes: &[i8], scales: &[f32], axis: usize, node: usize| {
        let nodes = axes.len() / scales.len();
        f64::from(axes[axis * nodes + node]) * f64::from(scales[axis])
    };
    let mut sum = 0.0;
    for i in 0..view_scales.len() {
        for j in 0..light_scales.len() {
            let core = f64::from(tucker.core[column][i * light_scales.len() + j]);
            sum += of(view_axes, view_scales, i, view) * core * of(light_axes, light_scales, j, light);
        }
    }
    sum * f64::from(tucker.core_steps[column])
}

#[test]
fn tables_are_products_of_axes_and_core() {
    let (tucker, _) = random();
    let rebuilt = tucker.tables(GRID.light_nodes());
    open(&file(DISPLAY), |found| {
        let mut largest = 0_i8;
        for (at, value) in found.table().iter().enumerate() {
            let (column, node) = (at % COLUMNS, at / COLUMNS);
            let (view, light) = (node / GRID.light_nodes(), node % GRID.light_nodes());
            let exact = entry(&tucker, column, view, light);
            assert!(exact.abs() < 127.0, "no entry is cut: {exact}");
            assert!(
                (f64::from(*value) - exact).abs() < 0.5 + 1e-3,
                "column {column} of {view}, {light}: {value} {exact}"
            );
            assert!((rebuilt[(node, column)] - f32::from(*value)).abs() < 1.5, "the encoder knows what is decoded");
            largest = largest.max(value.abs());
        }
        assert!(largest > 50, "numbers of all sizes: {largest}");
    });
}

#[test]
fn coefficients_are_sums_of_codewords() {
    let (_, texels) = random();
    open(&file(DISPLAY), |found| {
        for number in 0..TEXELS {
            let place = [(number % 4) as i32, (number / 4) as i32];
            let coefficients = found.coefficients(found.catalog().texel(0, 0, place).unwrap());
            for (row, coefficient) in coefficients.iter().enumerate() {
                let of_stage = |(stage, words): (usize, &DMatrix<f32>)| {
                    let word = usize::from(texels.indices[2 * number + stage]);
                    if row < words.nrows() { words[(row, word)] as i32 } else { 0 }
                };
                let sum: i32 = texels.words.iter().enumerate().map(of_stage).sum();
                assert_eq!(*coefficient, sum, "coefficient {row} of texel {number}");
            }
        }
    });
}

/// Y = Σ u b and C = ρ Y + Σ v q, where tables are read between nodes by the weights of their places.
#[test]
fn values_follow_the_formula_between_nodes_and_on_them() {
    let place = |count: u8, number: u32, is_ring: bool| {
        let count = u32::from(count);
        let first = (unit(number) * (count - u32::from(!is_ring)) as f32) as u32;
        // Some of them on a node.
        let weight = [0.0, 1.0, unit(number + 50), unit(number + 70)][number as usize % 4];
        LerpCoord { nodes: [first, (first + 1) % count], weight }
    };
    open(&file(DISPLAY), |found| {
        for number in 0..200_u32 {
            let cell = GridCoord {
                phi: place(GRID.n_phi, 4 * number, true),
                theta: place(GRID.n_theta, 5 * number + 1, false),
                alpha: place(GRID.n_alpha, 7 * number + 2, false),
                beta: place(GRID.n_beta, 9 * number + 3, false),
                fade: 1.0,
            };
            let texel = found.catalog().texel(0, 0, [number as i32, 2]).unwrap();
            let mut table = [0.0_f64; COLUMNS];
            for corner in 0..16 {
                let axis = |k: usize, place: LerpCoord| {
                    let side = corner >> k & 1;
                    (place.nodes[side] as usize, f64::from(place.weights()[side]))
                };
                let ((phi, a), (theta, b)) = (axis(0, cell.phi), axis(1, cell.theta));
                let ((alpha, c), (beta, d)) = (axis(2, cell.alpha), axis(3, cell.beta));
                let node = ((phi * 3 + theta) * 3 + alpha) * 4 + beta;
                for (column, sum) in table.iter_mut().enumerate() {
                    *sum += a * b * c * d * f64::from(found.table()[node * COLUMNS + column]);
                }
            }
            let steps = found.coefficients(texel).map(f64::from);
            let product =
                |column: usize, coefficient: usize| f64::from(FACTORS[column]) * table[column] * steps[coefficient];
            let y: f64 = (0..LUMA).map(|k| product(k, 2 + CHROMA + k)).sum();
            let chroma = |channel: usize| {
                let rest: f64 = (0..CHROMA).map(|k| product(LUMA + channel * CHROMA + k, 2 + k)).sum();
                f64::from(RATIO_STEPS[channel]) * steps[channel] * y + rest
            };
            for (value, exact) in found.channels(texel, &cell).into_iter().zip([y, chroma(0), chroma(1)]) {
                assert!((f64::from(value) - exact).abs() < 1e-4 * (1.0 + exact.abs()), "{value} {exact}");
            }
            let rgb = DISPLAY.decode(found.channels(texel, &cell));
            assert_eq!(Evaluate::eval_at(found, texel, &cell), rgb, "where nothing fades");
        }
    });
}

/// Uses all a file offers; whatever it says, values are numbers.
fn exercise(bytes: &[u8]) {
    let Ok(file) = FactoredBtf::parse_with(bytes, Crc::Skip) else { return };
    // What a damaged file asks for is up to its reader to grant.
    if file.table_len() > 1 << 20 {
        return;
    }
    let mut memory = ExpansionMemory::default();
    let expanded = file.expand_in(&mut memory).unwrap();
    for (number, light) in [[0.1, 0.2, 0.9], [0.9, -0.3, 0.1], [0.0, 0.0, 1.0], [f32::NAN; 3]].into_iter().enumerate() {
        if let Some(texel) = expanded.catalog().texel(0, 0, [number as i32; 2]) {
            let rgb = expanded.eval(texel, light, [0.3, -0.1, 0.9]);
            assert!(rgb.iter().all(|value| value.is_finite() && *value >= 0.0), "{rgb:?}");
        }
    }
}

#[test]
fn cut_files_are_refused() {
    let bytes = file(DISPLAY);
    for length in 0..bytes.len() {
        let error = FactoredBtf::parse_with(&bytes[..length], Crc::Skip).unwrap_err();
        assert!(matches!(error, ReadError::Truncated { .. }), "{length}: {error:?}");
    }
}

#[test]
fn damaged_files_are_refused_or_harmless() {
    for tone in [DISPLAY, ColourEncoding::LogLuv { toe: 0.01, peak: 10.0 }] {
        let bytes = file(tone);
        let mut accepted = 0;
        for at in 0..bytes.len() {
            for flip in [1, 0x80, 0xFF] {
                let mut bad = bytes.clone();
                bad[at] ^= flip;
                accepted += usize::from(FactoredBtf::parse_with(&bad, Crc::Skip).is_ok());
                exercise(&bad);
            }
        }
        assert!(accepted > bytes.len() / 4, "{accepted}: most damage reaches what is entropy-coded, or tables");
    }
}

#[test]
fn what_is_wrong_is_named() {
    let bytes = file(DISPLAY);
    let find = |section: Section| {
        let container = subsurf_decoder::container::Container::parse(&bytes).unwrap();
        let entry = container.entries().find(|entry| entry.section == section).unwrap();
        usize::try_from(entry.offset).unwrap()
    };
    let with = |at: usize, value: u8| {
        let mut bad = bytes.clone();
        bad[at] = value;
        FactoredBtf::parse_with(&bad, Crc::Skip).err()
    };
    let factors = find(Section::TuckerHeader);
    for (at, value) in [(0, 0), (0, 129), (1, 33), (2, 0), (2, 33), (4, 0), (4, 16), (5, 13), (10, 0), (14, 8)] {
        let offset = (factors + at) as u64;
        let wrong = ReadError::BadField { section: Section::TuckerHeader, offset, value: value.into() };
        assert_eq!(with(factors + at, value), Some(wrong), "byte {at} of FACT");
    }
    assert!(
        matches!(with(factors, 4), Some(ReadError::WrongSize { section: Section::TuckerHeader, .. })),
        "a component more"
    );
    let exponent = factors + 16 + 3;
    assert!(
        matches!(with(exponent, 0x7F), Some(ReadError::BadNumber { section: Section::TuckerHeader, .. })),
        "a step"
    );
    let index = find(Section::TexelIndices) + 7;
    let wrong = ReadError::IndexOutOfRange { section: Section::TexelIndices, offset: index as u64, index: 3, len: 3 };
    assert_eq!(with(index, 3), Some(wrong));
    assert!(
        matches!(
            subsurf_decoder::NestedBtf::parse(&bytes),
            Err(ReadError::OtherFamily { found: Family::FactoredBtf, .. })
        ),
        "another model"
    );
}

#[test]
fn short_buffers_are_refused() {
    use subsurf_decoder::btf::factored::ExpansionBuffers;
    let bytes = file(DISPLAY);
    let file = FactoredBtf::parse(&bytes).unwrap();
    let whole = [file.table_len(), file.words_len(), file.scratch_len()];
    for missing in 0..4 {
        let length = |k: usize| whole[k] - usize::from(k == missing);
        let (mut table, mut words, mut scratch) = (vec![0; length(0)], vec![0; length(1)], vec![0.0; length(2)]);
        let buffers = ExpansionBuffers { table: &mut table, words: &mut words, scratch: &mut scratch };
        assert_eq!(file.expand(buffers).is_some(), missing == 3, "one is missing in {missing}");
    }
}
