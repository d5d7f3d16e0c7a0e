//! Rows of what BTF files of both models begin with, as they pass.

use super::layout::BtfHeader;
use super::material::{MATERIAL_BYTES, Material};
use crate::container::Entry;
use crate::container::record::Field;
use crate::container::table::Table;
use crate::error::ReadError;
use crate::push::piece::Piece;
use crate::push::rows::{Arrived, Taken};
use crate::section::Section;

/// Header, and texels of the materials that have passed.
#[derive(Clone, Copy, Debug)]
pub(super) struct CatalogRows {
    pub(super) header: BtfHeader,
    texels: u32,
    /// Whether all materials have passed.
    is_whole: bool,
}

impl CatalogRows {
    /// Bytes of a row.
    pub(super) const ROW_BYTES: u64 = MATERIAL_BYTES as u64;

    /// Refuses files without materials, or with another number of them than the header has.
    pub(super) fn new(header: BtfHeader, table: Table<'_>) -> Result<Self, ReadError> {
        table.entry(Section::Materials)?.sized(header.materials_bytes())?;
        Ok(Self { header, texels: 0, is_whole: false })
    }

    /// Texels of all levels of all materials, for a section that needs to know.
    pub(super) fn texels(&self, entry: &Entry) -> Result<u32, ReadError> {
        if self.is_whole { Ok(self.texels) } else { Err(entry.out_of_order(Section::Materials)) }
    }

    /// Checks a material.
    pub(super) fn take<'r>(&mut self, arrived: &Arrived<'r>) -> Result<Taken<'r>, ReadError> {
        let row = arrived.row();
        let material = Material::from_bytes(&<[u8; MATERIAL_BYTES]>::from_bytes(row.bytes));
        material.check(row.origin)?;
        self.texels = self.texels.saturating_add(material.texels(u8::MAX));
        self.is_whole = arrived.is_last();
        if self.texels == u32::MAX {
            let (section, offset) = (Section::Materials, arrived.entry.offset);
            return Err(ReadError::BadField { section, offset, value: u32::MAX });
        }
        Ok(Taken::Piece(Piece::Material(material)))
    }
}
