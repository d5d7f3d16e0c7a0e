//! Rows of a BSSRDF's sections as they pass, checked with what checks whole sections.

use super::basis::BasisRows;
use super::layout::{BssrdfHeader, Coding, MODEL_2BMPP, MODEL_PER_PIXEL, pairs_in};
use super::values;
use crate::container::Entry;
use crate::container::table::Table;
use crate::error::ReadError;
use crate::push::rows::{Arrived, Rows, Taken, piece_bytes};
use crate::section::Section;

/// Header of a BSSRDF, and what of the section table its rows depend on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BssrdfRows {
    header: BssrdfHeader,
    /// Whether profiles are half floats.
    is_half: bool,
    /// Pairs of the palette, where there is one.
    pairs: u16,
    basis: BasisRows,
}

impl BssrdfRows {
    /// Refuses files without the sections that the header asks for, or with other sizes of them.
    pub(crate) fn new(header: BssrdfHeader, table: Table<'_>) -> Result<Self, ReadError> {
        let is_half = table.has(Section::HalfProfiles);
        let mut rows = Self { header, is_half, pairs: 0, basis: BasisRows::new(header.samples) };
        for &section in rows.planes() {
            let need_bytes = header.section_bytes(section);
            let entry = table.entry(section)?;
            if section == Section::Pairs {
                rows.pairs = pairs_in(entry.length)?;
            } else {
                entry.sized(need_bytes)?;
            }
        }
        Ok(rows)
    }

    /// Sections that the model needs.
    fn planes(&self) -> &'static [Section] {
        use Section::{
            BaseIndices, BaseProfiles, Codes, HalfProfiles, LocalProfiles, MixtureRatios, Pairs, SmallRatios,
        };
        let Self { header, is_half, .. } = self;
        match (header.model, header.coding, is_half) {
            (MODEL_PER_PIXEL, ..) => &[LocalProfiles],
            (_, Coding::Palette, false) => &[BaseProfiles, Pairs, Codes],
            (_, Coding::Palette, true) => &[HalfProfiles, Pairs, Codes],
            (_, Coding::SmallRatios, false) => &[BaseProfiles, SmallRatios, BaseIndices],
            (_, Coding::SmallRatios, true) => &[HalfProfiles, SmallRatios, BaseIndices],
            (1, Coding::Exact, false) => &[BaseProfiles, BaseIndices],
            (1, Coding::Exact, true) => &[HalfProfiles, BaseIndices],
            (_, Coding::Exact, false) => &[BaseProfiles, MixtureRatios, BaseIndices],
            (_, Coding::Exact, true) => &[HalfProfiles, MixtureRatios, BaseIndices],
        }
    }
}

impl Rows for BssrdfRows {
    fn reads(&self, entry: &Entry) -> bool {
        entry.section == Section::SeparableBasis || self.planes().contains(&entry.section)
    }

    fn row_bytes(&self, entry: &Entry, at: u64) -> Result<u64, ReadError> {
        const F32: u64 = 4;
        const RGB: u64 = 3;
        let width = u64::from(self.header.width);
        let bytes_of_pixel = match entry.section {
            Section::SeparableBasis => return Ok(self.basis.row_bytes(at)),
            // A node, so that rows are short whatever S.
            Section::BaseProfiles => return Ok(RGB * F32),
            Section::HalfProfiles => return Ok(RGB * 2),
            Section::Pairs => return Ok(piece_bytes(entry, at)),
            Section::LocalProfiles | Section::MixtureRatios => F32,
            Section::Codes => 2,
            Section::BaseIndices if self.header.model == MODEL_2BMPP => 2,
            Section::BaseIndices => self.header.index_bytes(),
            _ => 1,
        };
        Ok(width.saturating_mul(bytes_of_pixel))
    }

    fn take<'r>(&'r mut self, arrived: &Arrived<'r>) -> Result<Taken<'r>, ReadError> {
        let (row, materials) = (arrived.row(), self.header.base_materials);
        match arrived.entry.section {
            Section::SeparableBasis => return self.basis.take(arrived),
            Section::BaseProfiles | Section::LocalProfiles => drop(values::logs(row)?),
            Section::HalfProfiles => drop(values::half_logs(row)?),
            Section::MixtureRatios => drop(values::ratios(row)?),
            Section::Codes => drop(values::codes(row, self.pairs.into())?),
            Section::BaseIndices if self.header.index_bytes() == 2 => drop(values::wide_indices(row, materials)?),
            Section::BaseIndices | Section::Pairs => drop(values::indices(row, materials)?),
            _ => {}
        }
        Ok(Taken::Row)
    }
}
