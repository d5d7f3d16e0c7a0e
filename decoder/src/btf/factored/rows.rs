//! Rows of a Tucker decomposition as they pass, checked with what checks whole sections.

use super::layout::{FIXED_BYTES, STAGE_BYTES, TuckerShape, checked_steps, stages_end};
use super::reader::check_indices;
use crate::btf::layout::BtfHeader;
use crate::btf::rows::CatalogRows;
use crate::container::Entry;
use crate::container::table::Table;
use crate::error::ReadError;
use crate::push::piece::Piece;
use crate::push::rows::{Arrived, Rows, Taken, piece_bytes};
use crate::section::Section;

/// Header, materials and sizes of a Tucker decomposition.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FactoredRows {
    catalog: CatalogRows,
    shape: Option<TuckerShape>,
    /// Whether all stages have passed.
    is_whole: bool,
}

impl FactoredRows {
    /// Refuses files without one of their sections.
    pub(crate) fn new(header: BtfHeader, table: Table<'_>) -> Result<Self, ReadError> {
        use Section::{Axes, Codewords, Core, TexelIndices, TuckerHeader};
        let catalog = CatalogRows::new(header, table)?;
        [TuckerHeader, Axes, Core, Codewords, TexelIndices]
            .into_iter()
            .try_for_each(|section| table.entry(section).map(drop))?;
        Ok(Self { catalog, shape: None, is_whole: false })
    }

    /// Sizes, for a section that depends on them.
    fn shape(&self, entry: &Entry) -> Result<&TuckerShape, ReadError> {
        self.shape.as_ref().ok_or(entry.out_of_order(Section::TuckerHeader))
    }

    /// Takes a part of `FACT`; with the last stage, checks the sizes of all sections.
    fn take_header<'r>(&'r mut self, arrived: &Arrived<'r>) -> Result<Taken<'r>, ReadError> {
        let grid = &self.catalog.header.grid;
        let at = usize::try_from(arrived.at).unwrap_or(usize::MAX);
        if self.is_whole {
            checked_steps(arrived.row())?;
            return Ok(Taken::Row);
        }
        if at == 0 {
            self.shape = Some(TuckerShape::parse_fixed(arrived.row(), grid)?);
            return part(arrived, 1);
        }
        let Some(shape) = &mut self.shape else { return Ok(Taken::Part) };
        let number = at.saturating_sub(FIXED_BYTES) / STAGE_BYTES;
        shape.parse_stage(number, arrived.row())?;
        let passed = number.saturating_add(1);
        if passed < shape.count.into() {
            return part(arrived, passed.saturating_add(1));
        }
        self.is_whole = true;
        arrived.entry.sized(shape.section_bytes())?;
        arrived.table.entry(Section::Axes)?.sized(shape.axes_bytes(grid))?;
        let texels = self.catalog.texels(&arrived.entry)?;
        arrived.table.entry(Section::TexelIndices)?.sized(shape.indices_bytes(texels))?;
        Ok(Taken::Piece(Piece::Tucker(shape)))
    }

    /// Bytes of a part of `FACT`: the fixed ones, a stage, or a list of steps or scales.
    fn header_bytes(&self, at: u64) -> u64 {
        let Some(shape) = &self.shape else { return FIXED_BYTES as u64 };
        if !self.is_whole {
            return STAGE_BYTES as u64;
        }
        let mut start = stages_end(shape.count.into()) as u64;
        for length in shape.lengths() {
            let bytes = length.saturating_mul(size_of::<f32>()) as u64;
            if start == at {
                return bytes;
            }
            start = start.saturating_add(bytes);
        }
        0
    }
}

/// Part of `FACT`, which goes on at least up to the end of its first `stages` stages.
fn part<'r>(arrived: &Arrived<'_>, stages: usize) -> Result<Taken<'r>, ReadError> {
    if arrived.is_last() { Err(arrived.entry.wrong_size(stages_end(stages) as u64)) } else { Ok(Taken::Part) }
}

impl Rows for FactoredRows {
    fn reads(&self, entry: &Entry) -> bool {
        use Section::{Axes, Codewords, Core, Materials, TexelIndices, TuckerHeader};
        matches!(entry.section, Materials | TuckerHeader | Axes | Core | Codewords | TexelIndices)
    }

    fn row_bytes(&self, entry: &Entry, at: u64) -> Result<u64, ReadError> {
        let grid = &self.catalog.header.grid;
        Ok(match entry.section {
            Section::Materials => CatalogRows::ROW_BYTES,
            Section::TuckerHeader => {
                self.catalog.texels(entry)?;
                self.header_bytes(at)
            }
            Section::Axes if at < self.shape(entry)?.view_axes_len(grid) as u64 => grid.view_nodes() as u64,
            Section::Axes => grid.light_nodes() as u64,
            Section::TexelIndices => self.shape(entry)?.count.into(),
            _ => self.shape(entry).map(|_| piece_bytes(entry, at))?,
        })
    }

    fn take<'r>(&'r mut self, arrived: &Arrived<'r>) -> Result<Taken<'r>, ReadError> {
        match arrived.entry.section {
            Section::Materials => self.catalog.take(arrived),
            Section::TuckerHeader => self.take_header(arrived),
            Section::TexelIndices => {
                check_indices(arrived.row(), self.shape(&arrived.entry)?.stages()).map(|()| Taken::Row)
            }
            _ => Ok(Taken::Row),
        }
    }
}
