//! Offsets of all codebooks in a file, for those who read its bytes without this crate's code: shaders.

use super::layout::{CodebookSizes, MAX_STAGES, Scales, StageSizes};
use super::reader::NestedBtf;
use crate::container::Container;
use crate::container::bits::index_bits;
use crate::section::Section;
use core::num::Saturating;

/// Rows of items of a few bits (`FORMAT.md`, section 4.5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PackedTable {
    /// First byte in the file.
    pub start: u64,
    /// Items of a row.
    pub nodes: u8,
    /// Bits of an item.
    pub width: u32,
    /// Bits of the index that an item begins with.
    pub index_bits: u32,
    /// Entries that the index leads to: it is less.
    pub len: u32,
    /// Scales of the code above the index.
    pub scales: Scales,
}

/// Tables of one stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageTables {
    /// P6, P4, P3 and P2; items of P2 have what is above the lowest eight bits of their codes.
    pub tables: [PackedTable; 4],
    /// First byte in the file of the lowest eight bits of the codes of P2, rows of n_α bytes.
    pub p2_bytes: u64,
    /// First byte in the file of P1, rows of n_β values and an exponent.
    pub p1: u64,
}

/// Places of all codebooks of a file (`FORMAT.md`, sections 4.4 to 4.6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CodebookOffsets {
    /// Sizes and scales.
    pub sizes: CodebookSizes,
    /// Tables of luma, as many used as there are stages.
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

impl CodebookOffsets {
    /// Offsets in a checked file.
    #[must_use]
    pub fn of(btf: &NestedBtf<'_>) -> Self {
        let (sizes, grid) = (btf.codebooks().sizes(), btf.grid());
        let chroma = &sizes.chroma;
        // The file was checked: it is a container, and has these sections.
        let container = Container::parse(btf.file()).ok();
        let start = |section: Section| {
            let entry = container.as_ref().and_then(|file| file.entries().find(|entry| entry.section == section));
            entry.map_or(0, |entry| entry.offset)
        };
        let mut stages = [StageTables::default(); MAX_STAGES];
        for ((number, stage), of_stage) in (0_u8..).zip(&mut stages).zip(&sizes.stages).take(sizes.count) {
            let is_first = number == 0;
            let section = |book: u8| start(Section::Codebook { book, stage: number });
            let [.., p2] = of_stage.codebooks;
            // The codes' lowest bytes stand before the items of P2.
            let [rows, n_alpha] = [u64::from(p2.entries), grid.n_alpha.into()].map(Saturating);
            let p2_items = Saturating(section(2)) + rows * n_alpha;
            let starts = [section(6), section(4), section(3), p2_items.0];
            let nodes = [1, grid.n_phi, grid.n_theta, grid.n_alpha];
            let (widths, bits) = (of_stage.widths(is_first, chroma), of_stage.index_bits(is_first, chroma));
            let lens = of_stage.targets(is_first, chroma);
            let shapes = starts.into_iter().zip(nodes).zip(widths).zip(bits).zip(lens).zip(of_stage.codebooks);
            for (table, (((((start, nodes), width), index_bits), len), codebook)) in stage.tables.iter_mut().zip(shapes)
            {
                *table = PackedTable { start, nodes, width, index_bits, len, scales: codebook.scales };
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
        let [StageSizes { codebooks: [.., p2], .. }, ..] = sizes.stages;
        let merged = indices(Section::Merged, 1, p2.entries);
        Self {
            sizes: *sizes,
            stages,
            merged: PackedTable { width: merged.width.saturating_add(index_bits(chroma.i2)), ..merged },
            i2: indices(Section::ChromaSlices2, grid.n_alpha, chroma.i1),
            i1: indices(Section::ChromaSlices1, grid.n_beta, chroma.colours),
            colours: start(Section::Colours),
            tints: start(Section::Tints),
        }
    }
}
