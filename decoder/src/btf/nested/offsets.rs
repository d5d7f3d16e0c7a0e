//! Where the items of all codebooks stand in a file, for those who read its bytes without this crate's code: shaders.

use super::reader::Btf;
use crate::btf::layout::{Books, MAX_STAGES, Scales};
use crate::container::Container;
use crate::container::bits::index_bits;
use crate::error::Section;

/// Rows of items of a few bits (`FORMAT.md`, section 4.5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PackedTable {
    /// Its first byte in the file.
    pub start: u64,
    /// Items of a row.
    pub nodes: u8,
    /// Bits of an item.
    pub width: u32,
    /// Bits of the index that an item begins with.
    pub index_bits: u32,
    /// Entries that the index leads to: it is less.
    pub len: u32,
    /// What the code above the index stands for.
    pub scales: Scales,
}

/// The tables of one stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageTables {
    /// P6, P4, P3 and P2; items of P2 have what is above the lowest eight bits of their codes.
    pub tables: [PackedTable; 4],
    /// First byte in the file of the lowest eight bits of the codes of P2, rows of n_α bytes.
    pub p2_bytes: u64,
    /// First byte in the file of P1, rows of n_β values and a height.
    pub p1: u64,
}

/// Where all codebooks of a file are (`FORMAT.md`, sections 4.4 to 4.6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Codebooks {
    /// Sizes and scales.
    pub books: Books,
    /// Of luma, as many as there are stages.
    pub stages: [StageTables; MAX_STAGES],
    /// M: an index of P2 and, above it, one of I2.
    pub merged: PackedTable,
    /// I2: indices of I1.
    pub i2: PackedTable,
    /// I1: indices of C.
    pub i1: PackedTable,
    /// First byte in the file of C, two for each entry.
    pub colours: u64,
    /// First byte in the file of the tints, two for each; 0 if there are none.
    pub tints: u64,
}

impl Codebooks {
    /// Of a checked file.
    #[must_use]
    pub fn of(btf: &Btf<'_>) -> Self {
        let (books, grid) = (btf.nested().books(), btf.grid());
        let chroma = &books.chroma;
        // The file was checked: it is a container, and has these sections.
        let container = Container::parse(btf.file()).ok();
        let start = |section: Section| {
            let entry = container.as_ref().and_then(|file| file.entries().find(|entry| entry.section == section));
            entry.map_or(0, |entry| entry.offset)
        };
        let mut stages = [StageTables::default(); MAX_STAGES];
        for ((number, stage), of_books) in (0_u8..).zip(&mut stages).zip(&books.stages).take(books.count) {
            let is_first = number == 0;
            let section = |book: u8| start(Section::Codebook { book, stage: number });
            let [p6, p4, p3, p2] = of_books.books;
            let below_p3 = if is_first { chroma.merged } else { p2.entries };
            let lens = [p4.entries, p3.entries, below_p3, of_books.slices];
            let codes = u64::from(p2.entries).saturating_mul(grid.n_alpha.into());
            let starts = [section(6), section(4), section(3), section(2).saturating_add(codes)];
            let nodes = [1, grid.n_phi, grid.n_theta, grid.n_alpha];
            let scales = [p6.scales, p4.scales, p3.scales, p2.scales];
            let (widths, bits) = (of_books.widths(is_first, chroma), of_books.index_bits(is_first, chroma));
            let shapes = starts.into_iter().zip(nodes).zip(widths).zip(bits).zip(lens).zip(scales);
            for (table, (((((start, nodes), width), index_bits), len), scales)) in stage.tables.iter_mut().zip(shapes) {
                *table = PackedTable { start, nodes, width, index_bits, len, scales };
            }
            (stage.p2_bytes, stage.p1) = (section(2), section(1));
        }
        let indices = |section, nodes, len| PackedTable {
            start: start(section),
            nodes,
            width: index_bits(len),
            index_bits: index_bits(len),
            len,
            scales: Scales::default(),
        };
        let p2 = books.stages.first().map_or(0, |stage| {
            let [.., p2] = stage.books;
            p2.entries
        });
        let merged = indices(Section::Merged, 1, p2);
        Self {
            books: *books,
            stages,
            merged: PackedTable { width: merged.width.saturating_add(index_bits(chroma.i2)), ..merged },
            i2: indices(Section::ChromaSlices2, grid.n_alpha, chroma.i1),
            i1: indices(Section::ChromaSlices1, grid.n_beta, chroma.colours),
            colours: start(Section::Colours),
            tints: start(Section::Tints),
        }
    }
}
