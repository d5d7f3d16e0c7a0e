//! Files are read back bit by bit, without the decoder's own tables of items.

use subsurf_decoder::NestedBtf;
use subsurf_decoder::btf::nested::layout::Scales;
use subsurf_decoder::btf::{ColourEncoding, Grid};
use subsurf_decoder::container::{Container, Crc};

use super::*;
use crate::btf::nested::database::slice_mean;
use crate::synthetic::NestedShape;

/// Reads fields of a section one bit after the other.
struct Reader<'a> {
    bytes: &'a [u8],
    bit: usize,
}

impl<'a> Reader<'a> {
    fn of(file: &'a [u8], section: Section) -> Self {
        let (_, bytes) = Container::parse(file).unwrap().section(section, Crc::Check).unwrap();
        Self { bytes, bit: 0 }
    }

    fn next(&mut self, bits: u32) -> u32 {
        (0..bits).fold(0, |value, k| {
            let bit = u32::from(self.bytes[self.bit / 8] >> (self.bit % 8) & 1);
            self.bit += 1;
            value | bit << k
        })
    }

    /// Nothing but padding is left.
    fn end(&self) {
        let used = self.bit.div_ceil(8);
        assert_eq!(self.bytes.len(), used + PADDING_BYTES, "eight bytes follow");
        assert!(self.bytes[used..].iter().all(|byte| *byte == 0), "and are zero");
    }
}

/// Fewest bits that tell `count` things apart, counted one by one.
fn bits_of(count: usize) -> u32 {
    (0..).find(|bits| 1_usize << bits >= count).unwrap()
}

fn assert_same(database: &Database) {
    let file = database.to_bytes();
    let btf = NestedBtf::parse(&file).unwrap();
    assert_eq!(*btf.header(), database.header);
    assert!(btf.materials().eq(database.materials.iter().copied()), "materials");
    let books = btf.codebooks().sizes();
    let (grid, chroma) = (&database.header.grid, &database.chroma);
    let [n_phi, n_theta, n_alpha, n_beta] = [grid.n_phi, grid.n_theta, grid.n_alpha, grid.n_beta].map(usize::from);
    for (number, chain) in (0_u8..).zip(&database.stages) {
        let section = |book| Section::Codebook { book, stage: number };
        let tints = if number == 0 { &chroma.texel_tints[..] } else { &[] };
        let below_p3 = if number == 0 { chroma.merged.len() } else { chain.p2.len() / n_alpha };
        let codebooks: [(u8, &[Item], usize); 4] = [
            (6, &chain.texels, chain.p4.len() / n_phi),
            (4, &chain.p4, chain.p3.len() / n_theta),
            (3, &chain.p3, below_p3),
            (2, &chain.p2, chain.p1.len() / (n_beta + 1)),
        ];
        let slices = Reader::of(&file, section(1)).bytes;
        let (rows, padding) = slices.split_at(chain.p1.len());
        assert_eq!(padding, [0; PADDING_BYTES]);
        for (found, row) in rows.chunks(n_beta + 1).zip(chain.p1.chunks(n_beta + 1)) {
            assert_eq!(found[..n_beta], row[..n_beta], "values of P1");
        }
        let of_stage = &books.stages[usize::from(number)];
        assert_eq!((of_stage.slices as usize, of_stage.is_signed), (chain.p1.len() / (n_beta + 1), chain.is_signed));
        let rows = [1, n_phi, n_theta, n_alpha];
        for ((k, (book, items, len)), row) in codebooks.into_iter().enumerate().zip(rows) {
            let of_book = &of_stage.codebooks[k];
            assert_eq!(of_book.entries as usize * row, items.len(), "P{book}");
            let mut reader = Reader::of(&file, section(book));
            let bits = u32::from(of_book.scales.bits);
            let bytes: Vec<u32> = if book == 2 { items.iter().map(|_| reader.next(8)).collect() } else { Vec::new() };
            for (at, item) in items.iter().enumerate() {
                let index = reader.next(bits_of(len));
                let code = match bytes.get(at) {
                    Some(byte) => byte | reader.next(bits.saturating_sub(8)) << 8,
                    None => reader.next(bits),
                };
                if book == 2 {
                    // What the code lacks, the exponent of the slice has; steps are the same.
                    let of_slice = i32::from(slices[index as usize * (n_beta + 1) + n_beta]);
                    let exponent =
                        |scales: Scales, code: u32| i32::from(scales.offset) + (code.cast_signed() << scales.step);
                    let found = exponent(of_book.scales, code) + 2 * of_slice;
                    assert_eq!((index, found), (item.index, exponent(chain.scales[k], item.code)), "item {at} of P2");
                } else {
                    assert_eq!(of_book.scales, chain.scales[k], "P{book}");
                    assert_eq!((index, code), (item.index, item.code), "item {at} of P{book}, stage {number}");
                }
                if let (6, Some(tint)) = (book, tints.get(at)) {
                    assert_eq!(reader.next(bits_of(chroma.tints.len())), *tint, "tint of texel {at}");
                }
            }
            reader.end();
        }
    }
    let found = &books.chroma;
    assert_eq!((found.first, found.step, found.is_relative), (chroma.first, chroma.step, chroma.is_relative));
    let p2 = database.stages[0].p2.len() / n_alpha;
    let (i2, i1) = (chroma.i2.len() / n_alpha, chroma.i1.len() / n_beta);
    let mut reader = Reader::of(&file, Section::Merged);
    for pair in &chroma.merged {
        assert_eq!([reader.next(bits_of(p2)), reader.next(bits_of(i2))], *pair);
    }
    reader.end();
    let slices = [(Section::ChromaSlices2, &chroma.i2, i1), (Section::ChromaSlices1, &chroma.i1, chroma.colours.len())];
    for (section, items, len) in slices {
        let mut reader = Reader::of(&file, section);
        for item in items {
            assert_eq!(reader.next(bits_of(len)), *item, "{section}");
        }
        reader.end();
    }
    assert_eq!(Reader::of(&file, Section::Colours).bytes, chroma.colours.as_flattened());
    if !chroma.tints.is_empty() {
        assert_eq!(Reader::of(&file, Section::Tints).bytes, chroma.tints.as_flattened());
    }
}

#[test]
fn every_item_comes_back() {
    let odd = Grid { n_alpha: 7, n_beta: 9, n_theta: 2, n_phi: 1, alpha_max: 1.3, cos_light_min: 0.2, ..Grid::PAPER };
    let small = NestedShape::small();
    let shapes = [
        small.clone(),
        NestedShape { stages: 3, tints: 5, ..small.clone() },
        NestedShape { stages: 2, tints: 1, materials: vec![(5, 3, 3), (1, 7, 16)], ..small.clone() },
        NestedShape {
            grid: odd,
            is_relative: true,
            tone: ColourEncoding::LogLuv { toe: 0.01, peak: 9.0 },
            ..small.clone()
        },
        // One entry of everything: indices have no bits.
        NestedShape { luma: [1; 4], chroma: [1; 4], scale_bits: 0, ..small.clone() },
        // Powers of two and one more than them; wide scales.
        NestedShape { luma: [16, 17, 33, 64], chroma: [32, 9, 8, 257], tints: 4, scale_bits: 11, ..small },
    ];
    for (seed, shape) in (0..).zip(shapes) {
        assert_same(&shape.database(seed));
    }
}

#[test]
fn a_typical_file_has_200_kb() {
    let database = NestedShape::typical().database(1);
    let bytes = database.to_bytes().len();
    assert!((180_000..240_000).contains(&bytes), "{bytes}");
    assert_same(&database);
}

#[test]
#[should_panic(expected = "7 has more than 2 bits")]
fn indices_that_do_not_fit_are_not_written() {
    let mut database = NestedShape::small().database(0);
    database.stages[0].texels[1].index = 7;
    let _ = database.to_bytes();
}

#[test]
fn means_are_those_of_the_function() {
    assert_eq!(slice_mean(&[255, 255]), 255);
    // Half of each end: (127 / 2 + 255 / 2) / 1 is 191; 32 log2(191 / 255) is −13.34.
    assert_eq!(slice_mean(&[127, 255]), 242);
    // (128 / 2 + 0 + 127 / 2) / 2 is a quarter of 255: two octaves.
    assert_eq!(slice_mean(&[128, 0, 127]), 191);
    assert_eq!(slice_mean(&[0; 11]), 0, "nothing");
    assert_eq!(slice_mean(&[1; 64]), 0, "1 of 255 is nearly 2^(−255/32)");
}
