//! Checks a file of factors once.

use super::evaluate::Expanded;
use super::expand::{Buffers, expand};
use super::layout::{Factors, Shape, Stage};
use crate::btf::catalog::Catalog;
use crate::btf::layout::Model;
use crate::container::sections::Sections;
use crate::container::{Container, Crc};
use crate::error::{ReadError, Section};

/// A checked file of factors.
///
/// All its numbers are checked but those that are entropy-coded: any bytes are some numbers in their range.
#[derive(Clone, Copy, Debug)]
pub struct Factored<'a> {
    catalog: Catalog<'a>,
    pub(super) factors: Factors<'a>,
    /// `[view axis][view node]`, then `[light axis][light node]`.
    pub(super) view_axes: &'a [u8],
    pub(super) light_axes: &'a [u8],
    pub(super) core: &'a [u8],
    pub(super) words: &'a [u8],
    /// `[texel][stage]`
    pub(super) indices: &'a [u8],
}

impl<'a> Factored<'a> {
    /// Checks everything and borrows the file; nested codebooks are read by [`Btf`](crate::btf::Btf).
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ReadError> {
        Self::parse_with(bytes, Crc::Check)
    }

    /// [`Self::parse`], on request without comparing checksums; all other checks run.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn parse_with(bytes: &'a [u8], crc: Crc) -> Result<Self, ReadError> {
        let container = Container::parse(bytes)?;
        let sections = Sections { container: &container, crc };
        let catalog = Catalog::read(&sections)?;
        if catalog.header().model != Model::Factored {
            let offset = sections.start(Section::BtfHeader);
            return Err(ReadError::BadField { section: Section::BtfHeader, offset, value: 1 });
        }
        let grid = catalog.grid();
        let (start, bytes) = sections.any(Section::Factors)?;
        let factors = Factors::parse(bytes, start, grid)?;
        let shape = &factors.shape;
        let of_views = usize::from(shape.view_axes).saturating_mul(grid.view_nodes());
        let of_lights = usize::from(shape.light_axes).saturating_mul(grid.light_nodes());
        let axes = sections.sized(Section::Axes, of_views.saturating_add(of_lights) as u64)?;
        let (view_axes, light_axes) = axes.split_at_checked(of_views).unwrap_or((&[], &[]));
        let (_, core) = sections.any(Section::Core)?;
        let (_, words) = sections.any(Section::Codewords)?;
        let need = u64::from(catalog.texels()).saturating_mul(shape.count.into());
        let indices = sections.sized(Section::TexelIndices, need)?;
        check_indices(indices, shape.stages(), sections.start(Section::TexelIndices))?;
        Ok(Self { catalog, factors, view_axes, light_axes, core, words, indices })
    }

    /// Header and materials.
    #[must_use]
    pub fn catalog(&self) -> &Catalog<'a> {
        &self.catalog
    }

    /// Numbers of everything.
    #[must_use]
    pub fn shape(&self) -> &Shape {
        &self.factors.shape
    }

    /// Bytes of expanded tables: i8 `[φ_v][θ_v][α][β][column]`.
    #[must_use]
    pub fn table_len(&self) -> usize {
        let grid = self.catalog.grid();
        grid.view_nodes().saturating_mul(grid.light_nodes()).saturating_mul(self.shape().columns())
    }

    /// Numbers in expanded codewords: i16 `[stage][codeword][coefficient]`.
    #[must_use]
    pub fn words_len(&self) -> usize {
        self.shape().stages().iter().map(Stage::numbers).fold(0, usize::saturating_add)
    }

    /// Numbers that [`Self::expand`] needs for itself.
    #[must_use]
    pub fn scratch_len(&self) -> usize {
        let shape = self.shape();
        let core = usize::from(shape.view_axes).wrapping_mul(shape.light_axes.into());
        self.catalog.grid().light_nodes().wrapping_add(core << 1)
    }

    /// Undoes the entropy coding of codewords and tables, and multiplies the tables out; `None` where a buffer is
    /// shorter than [`Self::table_len`], [`Self::words_len`] and [`Self::scratch_len`] say.
    #[must_use]
    pub fn expand<'b>(&self, buffers: Buffers<'b, '_>) -> Option<Expanded<'b>>
    where
        'a: 'b,
    {
        expand(self, buffers)
    }
}

/// Every index is below the number of its stage's codewords.
fn check_indices(indices: &[u8], stages: &[Stage], start: u64) -> Result<(), ReadError> {
    if stages.iter().all(|stage| stage.words == 256) {
        return Ok(());
    }
    for (number, of_texel) in indices.chunks_exact(stages.len().max(1)).enumerate() {
        for (within, (index, stage)) in of_texel.iter().zip(stages).enumerate() {
            if u16::from(*index) >= stage.words {
                let before = number.saturating_mul(stages.len()).saturating_add(within);
                let offset = start.saturating_add(before as u64);
                let (index, len) = (u32::from(*index), u32::from(stage.words));
                return Err(ReadError::IndexOutOfRange { section: Section::TexelIndices, offset, index, len });
            }
        }
    }
    Ok(())
}
