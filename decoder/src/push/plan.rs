//! Which family's rows pass.

use super::piece::{Piece, Row};
use super::rows::{Arrived, Rows, Taken};
use crate::bssrdf::layout::BssrdfHeader;
use crate::bssrdf::{self, BssrdfRows};
use crate::btf::factored::FactoredRows;
use crate::btf::nested::NestedRows;
use crate::btf::{self, BtfHeader, BtfModel};
use crate::container::Entry;
use crate::error::ReadError;
use crate::kernel::{self, KernelHeader, KernelRows};
use crate::section::Section;
#[cfg(feature = "transfer")]
use crate::transfer::{self, TransferHeader, TransferRows};

/// Rows by what is known: of the header that is awaited, and then of its family.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant, reason = "there is no allocator to box the larger ones with")]
pub(super) enum Plan {
    /// The family's header has not passed.
    Header(Section),
    Bssrdf(BssrdfRows),
    Nested(NestedRows),
    Factored(FactoredRows),
    Kernel(KernelRows),
    #[cfg(feature = "transfer")]
    Transfer(TransferRows),
}

impl Plan {
    /// Checks the header of a family and that the file has its sections.
    fn start<'r>(&mut self, header: &Arrived<'r>, on_piece: &mut dyn FnMut(Piece<'_>)) -> Result<(), ReadError> {
        let (row, table) = (header.row(), header.table);
        match header.entry.section {
            Section::BtfHeader => {
                let header = BtfHeader::parse(row)?;
                *self = match header.model {
                    BtfModel::Nested => Self::Nested(NestedRows::new(header, table)?),
                    BtfModel::Factored => Self::Factored(FactoredRows::new(header, table)?),
                };
                on_piece(Piece::Btf(&header));
            }
            Section::KernelHeader => {
                let header = KernelHeader::parse(row)?;
                *self = Self::Kernel(KernelRows::new(header, table)?);
                on_piece(Piece::Kernel(&header));
            }
            #[cfg(feature = "transfer")]
            Section::TransferHeader => {
                let header = TransferHeader::parse(row)?;
                *self = Self::Transfer(TransferRows::new(header, table)?);
                on_piece(Piece::Transfer(&header));
            }
            _ => {
                let header = BssrdfHeader::parse(row)?;
                *self = Self::Bssrdf(BssrdfRows::new(header, table)?);
                on_piece(Piece::Bssrdf(&header));
            }
        }
        Ok(())
    }

    fn rows(&mut self) -> Option<&mut dyn Rows> {
        Some(match self {
            Self::Header(_) => return None,
            Self::Bssrdf(rows) => rows,
            Self::Nested(rows) => rows,
            Self::Factored(rows) => rows,
            Self::Kernel(rows) => rows,
            #[cfg(feature = "transfer")]
            Self::Transfer(rows) => rows,
        })
    }

    /// Whether a section is read, or passed over.
    pub(super) fn reads(&mut self, entry: &Entry) -> bool {
        match self.rows() {
            Some(rows) => rows.reads(entry),
            // What is known may be rows of the header to come.
            None => !matches!(entry.section, Section::Other(_) | Section::Metadata),
        }
    }

    /// Bytes of the row that begins at byte `at` of a section that is read; 0 where only fill follows.
    pub(super) fn row_bytes(&mut self, entry: &Entry, at: u64) -> Result<u64, ReadError> {
        let bytes = match self.rows() {
            Some(rows) => rows.row_bytes(entry, at)?,
            None => self.header_bytes(entry, at)?,
        };
        match at.saturating_add(bytes) {
            end if end > entry.length => Err(entry.wrong_size(end)),
            _ => Ok(bytes),
        }
    }

    /// Bytes of the header that is awaited. One that later versions made longer ends with what this one does not know.
    fn header_bytes(&self, entry: &Entry, at: u64) -> Result<u64, ReadError> {
        let Self::Header(header) = *self else { return Ok(0) };
        if entry.section != header {
            return Err(entry.out_of_order(header));
        }
        let bytes = match header {
            Section::BtfHeader => btf::layout::HEADER_BYTES,
            Section::KernelHeader => kernel::layout::HEADER_BYTES,
            #[cfg(feature = "transfer")]
            Section::TransferHeader => transfer::layout::HEADER_BYTES,
            _ => bssrdf::layout::HEADER_BYTES,
        };
        Ok(if at == 0 { bytes as u64 } else { 0 })
    }

    /// Checks a row and hands it out, with a number if it is one of a table; whether it is.
    pub(super) fn take(
        &mut self,
        arrived: &Arrived<'_>,
        number: u32,
        on_piece: &mut dyn FnMut(Piece<'_>),
    ) -> Result<bool, ReadError> {
        let Some(rows) = self.rows() else { return self.start(arrived, on_piece).map(|()| false) };
        let row = Row { section: arrived.entry.section, number, bytes: arrived.bytes };
        let taken = rows.take(arrived)?;
        match taken {
            Taken::Row => on_piece(Piece::Row(row)),
            Taken::Piece(piece) => on_piece(piece),
            Taken::Part => {}
        }
        Ok(matches!(taken, Taken::Row))
    }
}
