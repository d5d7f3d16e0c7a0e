//! Limits of nested codebooks: what is allowed up to the last value, and refused from the next one on, by size, scale, width of items and index.

use crate::common::{btf, place, seal_all};
use subsurf_decoder::btf::nested::layout::BOOK_BYTES;
use subsurf_decoder::{NestedBtf, ReadError, Section};

/// The file with some bytes of a section replaced, and sealed; the error that it has.
fn error_with(section: Section, changes: &[(usize, &[u8])]) -> Option<ReadError> {
    let mut bytes = btf::nested();
    let (start, _) = place(&bytes, section);
    for (at, value) in changes {
        bytes[start + at..start + at + value.len()].copy_from_slice(value);
    }
    let sections = usize::from(bytes[12]);
    seal_all(&mut bytes, sections);
    NestedBtf::parse(&bytes).err()
}

const BOOK: Section = Section::CodebookSizes;

/// Whether a value within `BOOK` is what is wrong.
fn is_refused(error: Option<ReadError>) -> bool {
    matches!(error, Some(ReadError::BadField { section: BOOK, .. } | ReadError::BadNumber { section: BOOK, .. }))
}

#[test]
fn numbers_of_entries() {
    const MOST: u32 = 1 << 24;
    // M, I2, I1, C; then P6, P4, P3, P2 and P1 of both stages.
    let codebooks = (1..=2).flat_map(|stage| (0..5).map(move |book| BOOK_BYTES * stage + 8 * book));
    for at in (0..4).map(|k| 4 * k).chain(codebooks) {
        for value in [0, MOST + 1, u32::MAX] {
            let error = error_with(BOOK, &[(at, &value.to_le_bytes())]);
            let is_due =
                matches!(error, Some(ReadError::BadField { section: BOOK, value: found, .. }) if found == value);
            assert!(is_due, "{value} at {at}: {error:?}");
        }
        assert!(!is_refused(error_with(BOOK, &[(at, &1_u32.to_le_bytes())])), "1 at {at}");
    }
    // As many as there can be do not fit into items with scales of ten bits.
    for at in [0, 4, 8, 12] {
        let error = error_with(BOOK, &[(at, &MOST.to_le_bytes())]);
        assert!(!matches!(error, Some(ReadError::BadField { value: MOST, .. })), "at {at}: {error:?}");
    }
    for stage in [0, 1] {
        for entries in [164_u32, 166] {
            let section = Section::Codebook { book: 6, stage };
            let due = ReadError::WrongSize { section, need_bytes: 165, have_bytes: entries.into() };
            let at = BOOK_BYTES * (1 + usize::from(stage));
            assert_eq!(error_with(BOOK, &[(at, &entries.to_le_bytes())]), Some(due), "an entry for each texel");
        }
    }
    // There may be no tints.
    for (tints, refused) in [(0, false), (MOST + 1, true)] {
        assert_eq!(is_refused(error_with(BOOK, &[(16, &u32::to_le_bytes(tints))])), refused, "{tints} tints");
    }
}

#[test]
fn chroma_and_flags() {
    for at in [20, 24, 28, 32] {
        for (value, refused) in [
            (-16.0_f32, false),
            (16.0, false),
            ((-16.0_f32).next_down(), true),
            (16.0_f32.next_up(), true),
            (f32::NAN, true),
        ] {
            assert_eq!(is_refused(error_with(BOOK, &[(at, &value.to_le_bytes())])), refused, "{value} at {at}");
        }
    }
    // Whether chroma is divided by luma, whether the stages have signs; the first one must not.
    for (at, allowed) in [(36, [true, true, false]), (40 + 36, [true, false, false]), (80 + 36, [true, true, false])] {
        for (value, allowed) in (0..).zip(allowed) {
            assert_eq!(error_with(BOOK, &[(at, &[value])]).is_none(), allowed, "{value} at {at}");
        }
    }
}

#[test]
fn scales() {
    // Bits, step and offset in 1/64 octaves; of P2 of the first stage, whose items have the narrowest codes.
    let (at, octaves_24) = (BOOK_BYTES + 3 * 8 + 4, 24 * 64_i16);
    let cases = [
        // The largest exponent is offset + (2^bits − 1) 2^step.
        ([11, 0], -octaves_24, false),
        ([12, 0], -octaves_24, true),
        ([10, 0], octaves_24 - 1023, false),
        ([10, 0], octaves_24 - 1022, true),
        ([4, 6], octaves_24 - 15 * 64, false),
        ([4, 6], octaves_24 - 15 * 64 + 1, true),
        ([0, 0], octaves_24, false),
        ([0, 0], octaves_24 + 1, true),
        ([0, 6], -octaves_24, false),
        ([0, 7], -octaves_24, true),
        ([0, 0], -octaves_24 - 1, true),
        ([0, 0], i16::MAX, true),
        ([17, 0], -octaves_24, true),
        ([32, 0], -octaves_24, true),
        ([255, 0], -octaves_24, true),
    ];
    for (codes, offset, refused) in cases {
        let error = error_with(BOOK, &[(at, &codes), (at + 2, &offset.to_le_bytes())]);
        assert_eq!(is_refused(error), refused, "{codes:?} {offset}: {error:?}");
    }
}

#[test]
fn widths_of_items() {
    // Items of 28 bits, and of one more: P6 of the first stage has an index of P4, a code of 10 bits and a tint of 2, P4 an index of P3
    // and a code, P3 one of M or P2. M has an index of P2, of 7 bits, and one of I2.
    let (first, second) = (BOOK_BYTES, 2 * BOOK_BYTES);
    type Sizes = &'static [(usize, u32)];
    let cases: [(&str, Sizes, usize, u32); 8] = [
        ("P6", &[], first + 8, 16),
        ("P6 of a later stage, which has no tints", &[], second + 8, 18),
        ("P6 by its tints", &[], 16, 15),
        ("P4", &[], first + 16, 18),
        ("P3", &[], 0, 18),
        ("P3 of a later stage", &[], second + 24, 18),
        ("M", &[], 4, 21),
        ("M by P2, with 17 entries of I2", &[(4, 17)], first + 24, 23),
    ];
    for (what, changes, at, bits) in cases {
        for (entries, refused) in [(1 << bits, false), ((1 << bits) + 1, true)] {
            let changes: Vec<_> =
                changes.iter().chain(&[(at, entries)]).map(|(at, entries)| (*at, entries.to_le_bytes())).collect();
            let changes: Vec<_> = changes.iter().map(|(at, bytes)| (*at, &bytes[..])).collect();
            let error = error_with(BOOK, &changes);
            assert_eq!(is_refused(error), refused, "{what}, {entries} entries: {error:?}");
        }
    }
}

#[test]
fn indices_of_packed_items() {
    let stage = |book, stage| Section::Codebook { book, stage };
    // Bytes before the items, how many there are, and their bits; first bit and bits of an index in them, and its limit.
    let cases: [(Section, usize, usize, usize, usize, usize, u32); 11] = [
        (stage(6, 0), 0, 165, 15, 0, 3, 5),
        (stage(6, 0), 0, 165, 15, 13, 2, 3),
        (stage(6, 1), 0, 165, 12, 0, 2, 3),
        (stage(4, 0), 0, 15, 12, 0, 2, 3),
        (stage(4, 1), 0, 9, 14, 0, 4, 9),
        (stage(3, 0), 0, 6, 13, 0, 3, 5),
        (stage(2, 0), 198, 198, 5, 0, 3, 7),
        (Section::Merged, 0, 5, 9, 0, 7, 66),
        (Section::Merged, 0, 5, 9, 7, 2, 3),
        (Section::ChromaSlices2, 0, 9, 7, 0, 7, 70),
        (Section::ChromaSlices1, 0, 140, 7, 0, 7, 67),
    ];
    let bytes = btf::nested();
    for (section, before, items, width, at, bits, len) in cases {
        let (start, length) = place(&bytes, section);
        assert_eq!(length, before + (items * width).div_ceil(8) + 8, "{section}");
        for (item, value) in [0, items / 2, items - 1]
            .into_iter()
            .flat_map(|item| [len - 1, len, (1 << bits) - 1].map(|value| (item, value)))
        {
            let first = item * width + at;
            let mut content = bytes[start + before..start + length].to_vec();
            for bit in 0..bits {
                let (byte, shift) = ((first + bit) / 8, (first + bit) % 8);
                content[byte] = content[byte] & !(1 << shift) | u8::from(value >> bit & 1 == 1) << shift;
            }
            let offset = (start + before + first / 8) as u64;
            let due = (value >= len).then_some(ReadError::IndexOutOfRange { section, offset, index: value, len });
            assert_eq!(error_with(section, &[(before, &content)]), due, "{value} in item {item} of {section}");
        }
    }
}
