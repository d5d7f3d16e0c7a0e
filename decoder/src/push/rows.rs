//! What a family says about the rows of its sections.

use super::piece::Piece;
use crate::container::Entry;
use crate::container::origin::Origin;
use crate::container::sections::SectionBytes;
use crate::container::table::Table;
use crate::error::ReadError;
use crate::section::Section;

/// Bytes of the pieces of what has no rows, pairs of bytes and codes of bits; the last may have fewer.
const PIECE_BYTES: u64 = 128;

/// Bytes of the piece that begins at byte `at` of a section.
pub(crate) fn piece_bytes(entry: &Entry, at: u64) -> u64 {
    PIECE_BYTES.min(entry.length.saturating_sub(at))
}

/// Rows of the sections of one family, by what of the file has passed.
pub(crate) trait Rows {
    /// Whether a section is read; others are passed over.
    fn reads(&self, entry: &Entry) -> bool;

    /// Bytes of the row that begins at byte `at` of a section; 0 where only fill follows.
    fn row_bytes(&self, entry: &Entry, at: u64) -> Result<u64, ReadError>;

    /// Checks a row as the reader of whole files does, and takes what later rows depend on.
    fn take<'r>(&'r mut self, row: &Arrived<'r>) -> Result<Taken<'r>, ReadError>;
}

/// What a row is handed out as.
#[derive(Clone, Copy)]
pub(crate) enum Taken<'r> {
    /// The row as it stands.
    Row,
    /// What it says.
    Piece(Piece<'r>),
    /// Nothing: a part of what is handed out when all of it is there.
    Part,
}

/// Row that is whole.
pub(crate) struct Arrived<'r> {
    /// Section table of the file.
    pub(crate) table: Table<'r>,
    /// Its section.
    pub(crate) entry: Entry,
    /// Its first byte in the section.
    pub(crate) at: u64,
    /// Its bytes.
    pub(crate) bytes: &'r [u8],
}

impl<'r> Arrived<'r> {
    /// The row as a part of its section.
    pub(crate) fn row(&self) -> SectionBytes<'r> {
        let offset = self.entry.offset.saturating_add(self.at);
        SectionBytes { origin: Origin { section: self.entry.section, offset }, bytes: self.bytes }
    }

    /// First byte of the section after the row.
    pub(crate) fn end(&self) -> u64 {
        self.at.saturating_add(self.bytes.len() as u64)
    }

    /// Whether the row is the last of its section.
    pub(crate) fn is_last(&self) -> bool {
        self.end() >= self.entry.length
    }
}

impl Entry {
    /// Refuses a section that does not have `need_bytes`.
    pub(crate) fn sized(&self, need_bytes: u64) -> Result<(), ReadError> {
        if self.length == need_bytes { Ok(()) } else { Err(self.wrong_size(need_bytes)) }
    }

    /// Error of a section that must have another size.
    pub(crate) fn wrong_size(&self, need_bytes: u64) -> ReadError {
        ReadError::WrongSize { section: self.section, need_bytes, have_bytes: self.length }
    }

    /// Error of a section that stands before one that it depends on.
    pub(crate) fn out_of_order(&self, needs: Section) -> ReadError {
        ReadError::OutOfOrder { section: self.section, needs }
    }
}
