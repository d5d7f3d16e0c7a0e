//! Items of 28 bits, the widest that there are, of which a reader of pushed bytes checks 64 at a time.

use crate::common::push::result;
use crate::common::{assemble, btf::pack};
use subsurf_decoder::btf::nested::layout::{ChromaSizes, CodebookSize, Scales, StageSizes};
use subsurf_decoder::btf::{BtfHeader, BtfModel, ColourEncoding, Grid, Material};
use subsurf_decoder::container::{Container, Crc};
use subsurf_decoder::{File, ReadError, Section};

/// 64 of a piece, and one.
const TEXELS: u16 = 65;
/// Nine bits of an index; eleven of a scale, more of which are beyond any exponent; eight of a tint.
const P4: u32 = 257;
const TINTS: u32 = 129;
const P6: Section = Section::Codebook { book: 6, stage: 0 };

/// File whose P6 has such items, other codebooks an entry or as few as they can.
fn file(items: &[[u32; 3]]) -> Vec<u8> {
    let grid = Grid { n_alpha: 2, n_beta: 2, n_theta: 2, n_phi: 2, ..Grid::PAPER };
    let encoding = ColourEncoding::Display { white: 1.0 };
    let header = BtfHeader { model: BtfModel::Nested, encoding, materials: 1, grid, texel_mm: None };
    let material = Material { name: [0; 24], width: TEXELS, height: 1, levels: 1 };
    let chroma = ChromaSizes {
        merged: 1,
        i2: 1,
        i1: 1,
        colours: 1,
        tints: TINTS,
        first: [0.0; 2],
        step: [0.0; 2],
        is_relative: false,
    };
    let size = |entries| CodebookSize { entries, scales: Scales::default() };
    let p6 = CodebookSize { entries: TEXELS.into(), scales: Scales { bits: 11, step: 0, offset: -1024 } };
    let stage = StageSizes { codebooks: [p6, size(P4), size(1), size(1)], slices: 1, is_signed: false };
    let p6 = pack(items.iter().map(|[index, code, tint]| vec![(*index, 9), (*code, 11), (*tint, 8)]));
    // Indices of one entry take no bits.
    let empty = [0; 8];
    assemble(&[
        (b"BTFH", &header.to_bytes()),
        (b"MATS", &material.to_bytes()),
        (b"BOOK", &[chroma.to_bytes(), stage.to_bytes()].concat()),
        (b"P6S0", &p6),
        (b"P4S0", &empty),
        (b"P3S0", &empty),
        (b"P2S0", &[0; 2 + 8]),
        (b"P1S0", &[0; 3 + 8]),
        (b"MERG", &empty),
        (b"CHR2", &empty),
        (b"CHR1", &empty),
        (b"CHRC", &[0; 2]),
        (b"TINT", &[0; 2 * TINTS as usize]),
    ])
}

#[test]
fn indices_are_checked_in_all_items_of_a_piece() {
    let largest = [P4 - 1, 2047, TINTS - 1];
    let sound = file(&[largest; TEXELS as usize]);
    assert_eq!((File::parse(&sound).map(drop), result(&sound, Crc::Check)), (Ok(()), Ok(())));
    let p6 = Container::parse(&sound).unwrap().entries().find(|entry| entry.section == P6).expect("P6");
    for item in [0, 1, 62, 63, 64] {
        for (wrong, first_bit, len) in [([P4, 0, 0], 0, P4), ([0, 0, TINTS], 20, TINTS)] {
            let mut items = [largest; TEXELS as usize];
            items[item] = wrong;
            let bytes = file(&items);
            let offset = p6.offset + (28 * item as u64 + first_bit) / 8;
            let due = Err(ReadError::IndexOutOfRange { section: P6, offset, index: len, len });
            assert_eq!(File::parse(&bytes).map(drop), due, "item {item}");
            assert_eq!(result(&bytes, Crc::Check), due, "item {item}, pushed");
        }
    }
}
