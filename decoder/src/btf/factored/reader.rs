//! Reads and checks a factored BTF file once.

use super::layout::{CodewordStage, TuckerHeader, TuckerShape};
use crate::btf::catalog::Catalog;
use crate::container::Crc;
use crate::container::sections::{SectionBytes, Sections};
use crate::error::ReadError;
use crate::family::Family;
use crate::section::Section;
use core::num::Saturating;

/// Checked BTF file of a Tucker decomposition.
///
/// All its numbers are checked but those that are entropy-coded: any bytes are some numbers in their range.
#[derive(Clone, Copy, Debug)]
pub struct FactoredBtf<'a> {
    catalog: Catalog<'a>,
    pub(super) header: TuckerHeader<'a>,
    /// i8 `[view axis][view node]`.
    pub(super) view_axes: &'a [u8],
    /// i8 `[light axis][light node]`.
    pub(super) light_axes: &'a [u8],
    /// Core tensor, entropy-coded.
    pub(super) core: &'a [u8],
    /// Codewords, entropy-coded.
    pub(super) words: &'a [u8],
    /// `[texel][stage]`.
    pub(super) indices: &'a [u8],
}

impl<'a> FactoredBtf<'a> {
    /// Reads and checks a file: structure, sizes, every value and index, and all CRCs.
    ///
    /// # Errors
    /// The first thing that is wrong, with section, offset and numbers.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ReadError> {
        Self::parse_with(bytes, Crc::Check)
    }

    /// [`Self::parse`] with a choice about the sections' CRC-32.
    ///
    /// # Errors
    /// As [`Self::parse`].
    pub fn parse_with(bytes: &'a [u8], crc: Crc) -> Result<Self, ReadError> {
        Self::read(&Sections::parse(bytes, crc)?)
    }

    /// Reads and checks all sections.
    #[inline(never)]
    pub(crate) fn read(sections: &Sections<'a>) -> Result<Self, ReadError> {
        let catalog = Catalog::read(sections, Family::FactoredBtf)?;
        let grid = catalog.grid();
        let header = TuckerHeader::parse(sections.any(Section::TuckerHeader)?, grid)?;
        let shape = &header.shape;
        let axes = sections.sized(Section::Axes, shape.axes_bytes(grid))?.bytes;
        let (view_axes, light_axes) = axes.split_at_checked(shape.view_axes_len(grid)).unwrap_or((&[], &[]));
        let core = sections.any(Section::Core)?.bytes;
        let words = sections.any(Section::Codewords)?.bytes;
        let indices = sections.sized(Section::TexelIndices, shape.indices_bytes(catalog.texels()))?;
        check_indices(indices, shape.stages())?;
        Ok(Self { catalog, header, view_axes, light_axes, core, words, indices: indices.bytes })
    }

    /// Header and materials.
    #[must_use]
    pub fn catalog(&self) -> &Catalog<'a> {
        &self.catalog
    }

    /// Sizes of the decomposition.
    #[must_use]
    pub fn shape(&self) -> &TuckerShape {
        &self.header.shape
    }

    /// Bytes of expanded tables: i8 `[φ_v][θ_v][α][β][column]`.
    #[must_use]
    pub fn table_len(&self) -> usize {
        let grid = self.catalog.grid();
        let [views, lights, columns] = [grid.view_nodes(), grid.light_nodes(), self.shape().columns()].map(Saturating);
        (views * lights * columns).0
    }

    /// Numbers in expanded codewords: i16 `[stage][codeword][coefficient]`.
    #[must_use]
    pub fn words_len(&self) -> usize {
        self.shape().stages().iter().map(CodewordStage::numbers).fold(0, usize::saturating_add)
    }

    /// Numbers that [`Self::expand`] needs for itself: f32 of all nodes of light, and of two cores.
    #[must_use]
    pub fn scratch_len(&self) -> usize {
        let [lights, core] = [self.catalog.grid().light_nodes(), self.shape().core_len()].map(Saturating);
        (lights + core + core).0
    }
}

/// Every index, `[texel][stage]`, is below the number of its stage's codewords.
pub(super) fn check_indices(section: SectionBytes<'_>, stages: &[CodewordStage]) -> Result<(), ReadError> {
    if stages.iter().all(|stage| stage.words == 256) {
        return Ok(());
    }
    let indices = section.bytes.iter().zip(stages.iter().cycle());
    for (at, (index, stage)) in indices.enumerate() {
        if u16::from(*index) >= stage.words {
            return Err(section.origin.at(at).bad_index((*index).into(), stage.words.into()));
        }
    }
    Ok(())
}
