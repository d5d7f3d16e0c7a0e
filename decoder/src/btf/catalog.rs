//! What BTF files of both models begin with: tone, grid and materials.

use super::grid::Grid;
use super::layout::{Header, MATERIAL_BYTES, Material};
use crate::container::sections::Sections;
use crate::container::{Container, Crc};
use crate::error::{ReadError, Section};

/// A texel of one of the mipmap levels of one of the materials of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Texel(pub(in crate::btf) u32);

impl Texel {
    /// Its number in the file: texels row by row, level by level, material by material.
    #[must_use]
    pub fn number(self) -> u32 {
        let Self(number) = self;
        number
    }
}

/// Header and materials of a BTF file of any model, checked.
#[derive(Clone, Copy, Debug)]
pub struct Catalog<'a> {
    header: Header,
    materials: &'a [[u8; MATERIAL_BYTES]],
}

impl<'a> Catalog<'a> {
    /// Checks header and materials, not the sections of the model: says what [`Btf`](super::Btf) or
    /// [`Factored`](super::Factored) is to read the file.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn parse(bytes: &'a [u8], crc: Crc) -> Result<Self, ReadError> {
        Self::read(&Sections { container: &Container::parse(bytes)?, crc })
    }

    /// [`Self::parse`] of a container's sections.
    pub(in crate::btf) fn read(sections: &Sections<'a, '_>) -> Result<Self, ReadError> {
        let (start, bytes) = sections.any(Section::BtfHeader)?;
        let header = Header::parse(bytes, start)?;
        let need = usize::from(header.materials).saturating_mul(MATERIAL_BYTES) as u64;
        let materials: &[[u8; MATERIAL_BYTES]] = sections.sized(Section::Materials, need)?.as_chunks().0;
        for (at, material) in (0..).step_by(MATERIAL_BYTES).zip(materials) {
            Material::parse(material, sections.start(Section::Materials).saturating_add(at))?;
        }
        Ok(Self { header, materials })
    }

    /// What the file says of itself.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Nodes of directions.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.header.grid
    }

    /// The materials.
    pub fn materials(&self) -> impl Iterator<Item = Material> + 'a {
        // All were read before.
        self.materials.iter().filter_map(|bytes| Material::parse(bytes, 0).ok())
    }

    /// Texels of all levels of all materials; at most 2³² − 1.
    #[must_use]
    pub fn texels(&self) -> u32 {
        self.materials().fold(0, |sum, material| sum.saturating_add(material.texels(u8::MAX)))
    }

    /// A texel by material, mipmap level and coordinates, which repeat; `None` if there is no such material or level.
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
