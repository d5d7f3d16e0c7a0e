//! Sections of packed items: sizes, and indices that stay within the codebook that they lead to.

use super::layout::{CodebookSizes, StageSizes};
use crate::btf::grid::Grid;
use crate::container::bits::{Items, PADDING_BYTES, field, index_bits, mask, packed_bytes};
use crate::container::sections::{SectionBytes, Sections};
use crate::error::ReadError;
use crate::section::Section;

/// Rows of items of one width.
#[derive(Clone, Copy)]
pub(super) struct Shape {
    /// Number of rows.
    pub(super) rows: u32,
    /// Items of a row.
    pub(super) nodes: u8,
    /// Bits of an item.
    pub(super) width: u32,
}

/// Index in every item of a table: its lowest bit in the item, and the number of entries that it must be less than.
pub(super) type Index = (u32, u32);

impl Shape {
    /// Number of items in all rows.
    pub(super) fn items(self) -> u64 {
        u64::from(self.rows).saturating_mul(self.nodes.into())
    }

    /// Bytes of all items.
    pub(super) fn bytes(self) -> u64 {
        packed_bytes(self.items(), self.width).unwrap_or(u64::MAX)
    }

    /// Items at the start of `section`, with their indices checked.
    pub(super) fn checked<'a>(self, section: SectionBytes<'a>, indices: &[Index]) -> Result<Items<'a>, ReadError> {
        let items = Items::new(section.bytes, self.width, self.nodes);
        indices.iter().try_for_each(|index| self.check(section, items, *index))?;
        Ok(items)
    }

    #[inline(never)]
    fn check(self, section: SectionBytes<'_>, items: Items<'_>, (at, len): Index) -> Result<(), ReadError> {
        let bits = index_bits(len);
        if len == 1_u32.wrapping_shl(bits) {
            // All that fits is in range.
            return Ok(());
        }
        let first_bit = |item: u64| item.saturating_mul(self.width.into());
        let index = |item: u64| {
            let offset = usize::try_from(first_bit(item)).unwrap_or(usize::MAX);
            field(items.bits(0, offset), at, mask(bits))
        };
        match (0..self.items()).find(|item| index(*item) >= len) {
            None => Ok(()),
            Some(item) => {
                let byte = first_bit(item).saturating_add(at.into()) >> 3;
                let byte = usize::try_from(byte).unwrap_or(usize::MAX);
                Err(section.origin.at(byte).bad_index(index(item), len))
            }
        }
    }
}

impl CodebookSizes {
    /// Rows of a section's items, and the indices in every item; `None` of sections without items, or of stages that there are not.
    pub(super) fn table(&self, section: Section, grid: &Grid) -> Option<(Shape, [Index; 2])> {
        /// Of one entry, which takes no bits.
        const NO_INDEX: Index = (0, 1);
        let chroma = &self.chroma;
        let indices = |rows, nodes, len| Some((Shape { rows, nodes, width: index_bits(len) }, [(0, len), NO_INDEX]));
        match section {
            Section::Codebook { book, stage: number } => {
                let (stage, is_first) = (self.stages.get(..self.count)?.get(usize::from(number))?, number == 0);
                let [p6, p4, p3, p2] = stage.codebooks;
                let [width_6, width_4, width_3, width_2] = stage.widths(is_first, chroma);
                let [of_p4, of_p3, below_p3, of_p1] = stage.targets(is_first, chroma);
                let (rows, nodes, width, target) = match book {
                    6 => (p6.entries, 1, width_6, of_p4),
                    4 => (p4.entries, grid.n_phi, width_4, of_p3),
                    3 => (p3.entries, grid.n_theta, width_3, below_p3),
                    2 => (p2.entries, grid.n_alpha, width_2, of_p1),
                    _ => return None,
                };
                let tint = (index_bits(of_p4).saturating_add(p6.scales.bits.into()), chroma.tints);
                let has_tint = book == 6 && is_first && chroma.tints > 0;
                Some((Shape { rows, nodes, width }, [(0, target), if has_tint { tint } else { NO_INDEX }]))
            }
            Section::Merged => {
                let [StageSizes { codebooks: [.., p2], .. }, ..] = self.stages;
                let p2_bits = index_bits(p2.entries);
                let width = p2_bits.saturating_add(index_bits(chroma.i2));
                Some((Shape { rows: chroma.merged, nodes: 1, width }, [(0, p2.entries), (p2_bits, chroma.i2)]))
            }
            Section::ChromaSlices2 => indices(chroma.i2, grid.n_alpha, chroma.i1),
            Section::ChromaSlices1 => indices(chroma.i1, grid.n_beta, chroma.colours),
            _ => None,
        }
    }

    /// Bytes before a section's items: in P2 the lowest eight bits of the codes, one for each item.
    pub(super) fn bytes_before(&self, section: Section, shape: Shape) -> u64 {
        if matches!(section, Section::Codebook { book: 2, .. }) { shape.items() } else { 0 }
    }

    /// Bytes that a section must have; `None` of those that are not of codebooks, or of stages or tints that there are not.
    pub(super) fn section_bytes(&self, section: Section, grid: &Grid) -> Option<u64> {
        if let Some((shape, _)) = self.table(section, grid) {
            return Some(self.bytes_before(section, shape).saturating_add(shape.bytes()));
        }
        let pairs = |entries: u32| Some(u64::from(entries).saturating_mul(2));
        match section {
            Section::Codebook { book: 1, stage } => {
                let stage = self.stages.get(..self.count)?.get(usize::from(stage))?;
                Some(stage.slices_bytes(grid.n_beta).saturating_add(PADDING_BYTES as u64))
            }
            Section::Colours => pairs(self.chroma.colours),
            Section::Tints if self.chroma.tints > 0 => pairs(self.chroma.tints),
            _ => None,
        }
    }
}

/// Sections of the codebooks of a checked file.
#[derive(Clone, Copy)]
pub(super) struct CodebookSections<'a, 'b> {
    pub(super) sections: &'b Sections<'a>,
    pub(super) sizes: &'b CodebookSizes,
    pub(super) grid: &'b Grid,
}

impl<'a> CodebookSections<'a, '_> {
    /// A section that has the size that follows from the headers.
    pub(super) fn sized(self, section: Section) -> Result<SectionBytes<'a>, ReadError> {
        self.sections.sized(section, self.sizes.section_bytes(section, self.grid).unwrap_or(0))
    }

    /// Items of a section, with their indices checked.
    pub(super) fn items(self, section: Section) -> Result<Items<'a>, ReadError> {
        let (shape, indices) = self.sizes.table(section, self.grid).ok_or(ReadError::Missing { section })?;
        let before = self.sizes.bytes_before(section, shape);
        let bytes = self.sections.sized(section, before.saturating_add(shape.bytes()))?;
        shape.checked(bytes.from(usize::try_from(before).unwrap_or(usize::MAX)), &indices)
    }
}
