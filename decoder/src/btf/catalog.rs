//! What BTF files of both models begin with: colour encoding, grid and materials.

use super::grid::Grid;
use super::layout::BtfHeader;
use super::material::{MATERIAL_BYTES, Material};
use crate::container::sections::Sections;
use crate::detect;
use crate::error::ReadError;
use crate::family::Family;
use crate::section::Section;

/// Texel of one of the mipmap levels of one of the materials of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Texel(pub(super) u32);

impl Texel {
    /// Texel of a number; from [`Catalog::texels`] on it is none, and has the values of none.
    #[must_use]
    pub fn from_number(number: u32) -> Self {
        Self(number)
    }

    /// Number in the file: texels row by row, level by level, material by material.
    #[must_use]
    pub fn number(self) -> u32 {
        let Self(number) = self;
        number
    }
}

/// Checked header and materials of a BTF file of either model.
#[derive(Clone, Copy, Debug)]
pub struct Catalog<'a> {
    header: BtfHeader,
    materials: &'a [[u8; MATERIAL_BYTES]],
}

impl<'a> Catalog<'a> {
    /// Checks header and materials of a file of the expected family.
    pub(super) fn read(sections: &Sections<'a>, expected: Family) -> Result<Self, ReadError> {
        let header = BtfHeader::parse(detect::header(sections, Section::BtfHeader, expected)?)?;
        let section = sections.sized(Section::Materials, header.materials_bytes())?;
        let (materials, _) = section.bytes.as_chunks();
        for (number, material) in materials.iter().enumerate() {
            Material::from_bytes(material).check(section.origin.at_item(number, MATERIAL_BYTES))?;
        }
        let catalog = Self { header, materials };
        // As many as that, or more.
        if catalog.texels() == u32::MAX { Err(section.origin.bad_field(0, u32::MAX)) } else { Ok(catalog) }
    }

    /// Model, colour encoding and grid.
    #[must_use]
    pub fn header(&self) -> &BtfHeader {
        &self.header
    }

    /// Nodes of directions.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.header.grid
    }

    /// Materials in file order.
    pub fn materials(&self) -> impl Iterator<Item = Material> + 'a {
        self.materials.iter().map(Material::from_bytes)
    }

    /// Number of texels of all levels of all materials; fewer than 2³² − 1.
    #[must_use]
    #[inline(never)]
    pub fn texels(&self) -> u32 {
        self.materials().fold(0, |sum, material| sum.saturating_add(material.texels(u8::MAX)))
    }

    /// Texel by material, mipmap level and coordinates, which repeat; `None` if there is no such material or level.
    #[must_use]
    pub fn texel(&self, material: usize, level: u8, [x, y]: [i32; 2]) -> Option<Texel> {
        let of = self.materials().nth(material).filter(|of| level < of.levels)?;
        let before = self.materials().take(material).fold(0_u32, |sum, other| sum.wrapping_add(other.texels(u8::MAX)));
        let [width, height] = of.size(level).map(u32::cast_signed);
        let (x, y) = (x.checked_rem_euclid(width)?, y.checked_rem_euclid(height)?);
        let inside = y.wrapping_mul(width).wrapping_add(x).cast_unsigned();
        Some(Texel(before.wrapping_add(of.texels(level)).wrapping_add(inside)))
    }
}
