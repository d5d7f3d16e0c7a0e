//! Values of nested BTFs whose codebooks are next to empty, so that each part of a value can be told by hand.

use crate::common::{assemble, btf::pack};
use subsurf_decoder::NestedBtf;
use subsurf_decoder::btf::nested::layout::{ChromaSizes, CodebookSize, Scales, StageSizes};
use subsurf_decoder::btf::{
    BtfHeader, BtfModel, ColourEncoding, Evaluate, Grid, GridCoord, LerpCoord, Material, Texel,
};

const GRID: Grid = Grid { n_alpha: 2, n_beta: 2, n_theta: 2, n_phi: 2, ..Grid::PAPER };
/// Coordinates whose 16 nodes have different weights.
const COORD: GridCoord = GridCoord {
    phi: LerpCoord { nodes: [0, 1], weight: 0.25 },
    theta: LerpCoord { nodes: [0, 1], weight: 0.5 },
    alpha: LerpCoord { nodes: [0, 1], weight: 0.75 },
    beta: LerpCoord { nodes: [0, 1], weight: 0.125 },
    fade: 1.0,
};

/// File of one texel in two stages, with a value of all slices for each of them. Rows of P3 and M are two, so that the node of view at which
/// both coordinates are the last, and none other, has another colour.
struct Plain {
    luma: [u8; 2],
    is_signed: bool,
    is_relative: bool,
}

impl Plain {
    fn file(&self) -> Vec<u8> {
        let encoding = ColourEncoding::Display { white: 1.0 };
        let header = BtfHeader { model: BtfModel::Nested, encoding, materials: 1, grid: GRID, texel_mm: None };
        let material = Material { name: [0; 24], width: 1, height: 1, levels: 1 };
        let is_relative = self.is_relative;
        let chroma = ChromaSizes {
            merged: 2,
            i2: 2,
            i1: 2,
            colours: 2,
            tints: 0,
            first: [0.0; 2],
            step: [0.001; 2],
            is_relative,
        };
        let size = |entries| CodebookSize { entries, scales: Scales::default() };
        let stage =
            |p3, is_signed| StageSizes { codebooks: [size(1), size(1), size(p3), size(1)], slices: 1, is_signed };
        let book = [chroma.to_bytes(), stage(2, false).to_bytes(), stage(1, self.is_signed).to_bytes()].concat();
        let items = |values: &[u32]| pack(values.iter().map(|value| vec![(*value, 1)]));
        // φ 0 leads to row 0 of P3, φ 1 to row 1; this has row 1 of M at θ 1.
        let (p4, p3) = (items(&[0, 1]), items(&[0, 0, 0, 1]));
        let (m, i2, i1) = (items(&[0, 1]), items(&[0, 0, 1, 1]), items(&[0, 0, 1, 1]));
        let empty = [0; 8];
        let p2 = [0; 2 + 8];
        // Two values and an exponent.
        let slices = self.luma.map(|luma| [&[luma, luma, 0], &empty[..]].concat());
        assemble(&[
            (b"BTFH", &header.to_bytes()),
            (b"MATS", &material.to_bytes()),
            (b"BOOK", &book),
            (b"P6S0", &empty),
            (b"P4S0", &p4),
            (b"P3S0", &p3),
            (b"P2S0", &p2),
            (b"P1S0", &slices[0]),
            (b"P6S1", &empty),
            (b"P4S1", &empty),
            (b"P3S1", &empty),
            (b"P2S1", &p2),
            (b"P1S1", &slices[1]),
            (b"MERG", &m),
            (b"CHR2", &i2),
            (b"CHR1", &i1),
            // Codes of a and b of both colours.
            (b"CHRC", &[0, 0, 80, 80]),
        ])
    }

    /// Luma and both channels of chroma.
    fn channels(&self) -> [f64; 3] {
        let bytes = self.file();
        let btf = NestedBtf::parse(&bytes).unwrap();
        let [red, green, blue] = btf.eval_at(Texel::from_number(0), &COORD).map(f64::from);
        let luma = 0.299 * red + 0.587 * green + 0.114 * blue;
        [luma, 0.713 * (red - luma), 0.564 * (blue - luma)]
    }
}

fn assert_channels(plain: &Plain, due: [f64; 3]) {
    let found = plain.channels();
    let is_due = found.iter().zip(due).all(|(found, due)| (found - due).abs() < 1e-6);
    assert!(is_due, "{:?}: {found:?}, not {due:?}", plain.luma);
}

/// Chroma of the second colour.
const SECOND: f64 = 0.08;
/// Weight of the node of view that has it.
const SHARE: f64 = 0.25 * 0.5;

#[test]
fn luma_of_stages_adds_up() {
    for (luma, is_signed, due) in [
        ([100, 0], false, 100.0 / 255.0),
        ([100, 60], false, 160.0 / 255.0),
        ([100, 60], true, 100.0 / 255.0 + 60.0 / 127.0),
        // Codes of signed stages are i8.
        ([200, 216], true, 200.0 / 255.0 - 40.0 / 127.0),
        ([30, 216], false, 246.0 / 255.0),
    ] {
        assert_channels(&Plain { luma, is_signed, is_relative: false }, [due, SHARE * SECOND, SHARE * SECOND]);
    }
}

#[test]
fn one_node_of_another_colour_counts_by_its_weight() {
    let luma = [127, 0];
    let y = 127.0 / 255.0;
    assert_channels(&Plain { luma, is_signed: false, is_relative: false }, [y, SHARE * SECOND, SHARE * SECOND]);
    let relative = y * SHARE * SECOND;
    assert_channels(&Plain { luma, is_signed: false, is_relative: true }, [y, relative, relative]);
}

#[test]
fn chroma_of_no_luma_is_none() {
    assert_channels(&Plain { luma: [0, 0], is_signed: false, is_relative: true }, [0.0; 3]);
    // Later stages brighten it, and leave chroma alone.
    assert_channels(&Plain { luma: [0, 51], is_signed: false, is_relative: true }, [0.2, 0.0, 0.0]);
}

#[test]
fn values_are_the_same_by_every_way_to_ask() {
    let (light, view) = ([0.48, 0.36, 0.8], [-0.6, 0.0, 0.8]);
    for name in ["nested_display", "nested_log_luv_stages"] {
        let bytes = std::fs::read(format!("../tests/vectors/{name}.subsurf")).unwrap();
        let btf = NestedBtf::parse(&bytes).unwrap();
        let texel = btf.texel(0, 0, [1, 1]).unwrap();
        let value = Evaluate::eval(&btf, texel, light, view);
        assert!(value.iter().all(|value| *value > 0.0 && *value != 1.0), "{name}: {value:?}");
        assert_eq!(btf.eval(texel, light, view), value, "{name}");
        assert_eq!(btf.eval_for(texel, light, &btf.grid().view(view)), value, "{name}");
    }
}
