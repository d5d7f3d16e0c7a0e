//! Rows of nested codebooks as they pass, checked with what checks whole sections.

use super::layout::{CodebookSizes, need_bytes};
use super::packed::Shape;
use super::stage::check_texels;
use crate::btf::layout::BtfHeader;
use crate::btf::rows::CatalogRows;
use crate::container::Entry;
use crate::container::bits::{MAX_ITEM_BITS, PADDING_BYTES};
use crate::container::sections::SectionBytes;
use crate::container::table::Table;
use crate::error::ReadError;
use crate::push::piece::Piece;
use crate::push::rows::{Arrived, Rows, Taken, piece_bytes};
use crate::section::Section;

/// Items of a piece of a table: whole bytes whatever their width.
const PIECE_ITEMS: u64 = 64;
/// Bytes of a piece of the widest items, and what every item can be read with.
const PADDED_BYTES: usize = 8 * MAX_ITEM_BITS as usize + PADDING_BYTES;

/// Header, materials and sizes of nested codebooks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NestedRows {
    catalog: CatalogRows,
    sizes: Option<CodebookSizes>,
}

impl NestedRows {
    /// Refuses files without materials and sizes of codebooks.
    pub(crate) fn new(header: BtfHeader, table: Table<'_>) -> Result<Self, ReadError> {
        table.entry(Section::CodebookSizes)?;
        Ok(Self { catalog: CatalogRows::new(header, table)?, sizes: None })
    }

    /// Sizes of the codebooks, for a section that depends on them.
    fn sizes(&self, entry: &Entry) -> Result<&CodebookSizes, ReadError> {
        self.sizes.as_ref().ok_or(entry.out_of_order(Section::CodebookSizes))
    }

    /// Checks sizes, and that the file has all codebooks in these sizes.
    fn set_sizes(&mut self, arrived: &Arrived<'_>) -> Result<&CodebookSizes, ReadError> {
        let texels = self.catalog.texels(&arrived.entry)?;
        let sizes = CodebookSizes::parse(arrived.row())?;
        let sized = |section| {
            let need_bytes = sizes.section_bytes(section, &self.catalog.header.grid).unwrap_or(0);
            arrived.table.entry(section)?.sized(need_bytes)
        };
        for (stage, of_stage) in (0..).zip(&sizes.stages).take(sizes.count) {
            let [p6, ..] = of_stage.codebooks;
            check_texels(Section::Codebook { book: 6, stage }, p6, texels)?;
            [6, 4, 3, 2, 1].into_iter().try_for_each(|book| sized(Section::Codebook { book, stage }))?;
        }
        [Section::Merged, Section::ChromaSlices2, Section::ChromaSlices1, Section::Colours]
            .into_iter()
            .try_for_each(sized)?;
        if sizes.chroma.tints > 0 {
            sized(Section::Tints)?;
        }
        Ok(self.sizes.insert(sizes))
    }
}

impl Rows for NestedRows {
    fn reads(&self, entry: &Entry) -> bool {
        match (entry.section, &self.sizes) {
            (Section::Materials | Section::CodebookSizes, _) => true,
            (section, Some(sizes)) => sizes.section_bytes(section, &self.catalog.header.grid).is_some(),
            // Whether the file has as many stages is not known yet.
            (Section::Codebook { .. } | Section::Merged, None) => true,
            (section, None) => {
                matches!(section, Section::ChromaSlices2 | Section::ChromaSlices1 | Section::Colours | Section::Tints)
            }
        }
    }

    fn row_bytes(&self, entry: &Entry, at: u64) -> Result<u64, ReadError> {
        let grid = &self.catalog.header.grid;
        match entry.section {
            Section::Materials => return Ok(CatalogRows::ROW_BYTES),
            Section::CodebookSizes => {
                self.catalog.texels(entry)?;
                entry.sized(need_bytes(entry.length))?;
                return Ok(entry.length);
            }
            _ => {}
        }
        let sizes = self.sizes(entry)?;
        let Some((shape, _)) = sizes.table(entry.section, grid) else {
            let Section::Codebook { stage, .. } = entry.section else { return Ok(piece_bytes(entry, at)) };
            let of_stage = sizes.stages.get(usize::from(stage)).copied().unwrap_or_default();
            let slice = u64::from(grid.n_beta).saturating_add(1);
            return Ok(if at < of_stage.slices_bytes(grid.n_beta) { slice } else { 0 });
        };
        let before = sizes.bytes_before(entry.section, shape);
        Ok(if at < before { shape.nodes.into() } else { piece(shape, at.saturating_sub(before)).1 })
    }

    fn take<'r>(&'r mut self, arrived: &Arrived<'r>) -> Result<Taken<'r>, ReadError> {
        match arrived.entry.section {
            Section::Materials => return self.catalog.take(arrived),
            Section::CodebookSizes => {
                return self.set_sizes(arrived).map(|sizes| Taken::Piece(Piece::Codebooks(sizes)));
            }
            _ => {}
        }
        let (row, sizes) = (arrived.row(), self.sizes(&arrived.entry)?);
        if let Some((shape, indices)) = sizes.table(row.origin.section, &self.catalog.header.grid)
            && let Some(at) = arrived.at.checked_sub(sizes.bytes_before(row.origin.section, shape))
        {
            let mut padded = [0; PADDED_BYTES];
            padded.iter_mut().zip(row.bytes).for_each(|(to, from)| *to = *from);
            let (items, _) = piece(shape, at);
            let rows = u32::try_from(items).unwrap_or(0);
            Shape { rows, nodes: 1, ..shape }.checked(SectionBytes { bytes: &padded, ..row }, &indices)?;
        }
        Ok(Taken::Row)
    }
}

/// Items and bytes of the piece that begins at a byte of a table.
fn piece(shape: Shape, at: u64) -> (u64, u64) {
    let width = u64::from(shape.width);
    // Bytes before it are those of whole pieces, of eight items to `width` bytes.
    let before = at.saturating_mul(8).checked_div(width).unwrap_or(u64::MAX);
    let items = shape.items().saturating_sub(before).min(PIECE_ITEMS);
    (items, items.saturating_mul(width).div_ceil(8))
}
