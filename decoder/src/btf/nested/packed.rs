//! Sections of packed items: sizes, and indices that stay within the codebook that they lead to.

use crate::container::bits::{Items, field, index_bits, mask, packed_bytes};
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

/// A section that consists of items alone, with their indices checked.
#[inline(never)]
pub(super) fn items<'a>(
    sections: &Sections<'a>,
    section: Section,
    shape: Shape,
    indices: &[Index],
) -> Result<Items<'a>, ReadError> {
    shape.checked(sections.sized(section, shape.bytes())?, indices)
}
