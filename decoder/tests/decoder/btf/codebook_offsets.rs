//! Offsets of nested codebooks, by which shaders read a file's bytes, against the file that was packed bit by bit.

use crate::common::{btf, place};
use subsurf_decoder::btf::nested::layout::Scales;
use subsurf_decoder::btf::{CodebookOffsets, PackedTable, StageTables};
use subsurf_decoder::{NestedBtf, Section};

#[test]
fn tables_begin_where_their_sections_do() {
    let bytes = btf::nested();
    let file = NestedBtf::parse(&bytes).unwrap();
    let of = CodebookOffsets::of(&file);
    assert_eq!(&of.sizes, file.codebooks().sizes());
    let start = |section| place(&bytes, section).0 as u64;
    let table = |section, before, nodes, width, index_bits, len, scales| PackedTable {
        start: start(section) + before,
        nodes,
        width,
        index_bits,
        len,
        scales,
    };
    let codes = Scales { bits: 10, step: 1, offset: -600 };
    // Two stages: bits of an item and of its index, and entries that this leads to; P2 after the lowest bytes of its codes.
    let p2_rows = [66, 2];
    let due = [[(15, 3, 5), (12, 2, 3), (13, 3, 5), (5, 3, 7)], [(12, 2, 3), (14, 4, 9), (11, 1, 2), (2, 0, 1)]];
    for (number, (rows, [p6, p4, p3, p2])) in (0..).zip(p2_rows.into_iter().zip(due)) {
        let section = |book| Section::Codebook { book, stage: number };
        let of_book = |book, before, nodes, (width, index_bits, len)| {
            table(section(book), before, nodes, width, index_bits, len, codes)
        };
        let due = StageTables {
            tables: [of_book(6, 0, 1, p6), of_book(4, 0, 3, p4), of_book(3, 0, 2, p3), of_book(2, 3 * rows, 3, p2)],
            p2_bytes: start(section(2)),
            p1: start(section(1)),
        };
        assert_eq!(of.stages[usize::from(number)], due, "stage {number}");
    }
    assert_eq!(of.stages[2..], [StageTables::default(); 2], "no more of them");
    let none = Scales::default();
    assert_eq!(of.merged, table(Section::Merged, 0, 1, 9, 7, 66, none));
    assert_eq!(of.i2, table(Section::ChromaSlices2, 0, 3, 7, 7, 70, none));
    assert_eq!(of.i1, table(Section::ChromaSlices1, 0, 2, 7, 7, 67, none));
    assert_eq!([of.colours, of.tints], [Section::Colours, Section::Tints].map(start));
}

#[test]
fn no_tints_begin_nowhere() {
    let bytes = std::fs::read("../tests/vectors/nested_display.subsurf").unwrap();
    let file = NestedBtf::parse(&bytes).unwrap();
    assert_eq!(file.codebooks().sizes().chroma.tints, 0);
    assert_eq!(CodebookOffsets::of(&file).tints, 0);
}
