//! The container: file header, section table, CRC-32 (`FORMAT.md`, section 1), and how bytes become numbers.
//!
//! All offset arithmetic of the crate is here.

pub mod bits;
pub mod bytes;
pub(crate) mod crc;
mod header;
pub(crate) mod index;
mod metadata;
pub(crate) mod origin;
pub(crate) mod record;
pub(crate) mod sections;
pub(crate) mod table;

pub use crc::crc32;
pub use header::{ENTRY_BYTES, Entry, FILE_HEADER_BYTES, MAGIC, MAJOR, MAX_SECTIONS, MINOR, file_header};
pub use metadata::{MAX_KEY_BYTES, MAX_VALUE_BYTES, Metadata, entry_header};

use crate::error::ReadError;
use crate::section::Section;
use bytes::slice_at;
use table::{Start, Table, truncated};

/// Whether to compare the CRC-32 of the sections that are read; the header's own is always compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crc {
    /// Compare.
    Check,
    /// Trust the storage. All other checks still run, so that any input stays harmless.
    Skip,
}

/// File whose header and section table were checked.
#[derive(Clone, Copy, Debug)]
pub struct Container<'a> {
    file: &'a [u8],
    pub(crate) table: Table<'a>,
    minor: u16,
}

impl<'a> Container<'a> {
    /// Checks magic, version, length, section table and the header's CRC.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place and the numbers.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ReadError> {
        let start = Start::parse(bytes)?;
        let file = slice_at(bytes, 0, start.file_bytes).ok_or(truncated(start.file_bytes, bytes.len() as u64))?;
        let header = file.get(..start.header_end()?).unwrap_or(file);
        Ok(Self { file, table: Table::parse(header, &start)?, minor: start.minor })
    }

    /// Entries of the section table, in file order.
    pub fn entries(&self) -> impl Iterator<Item = Entry> + 'a {
        self.table.entries()
    }

    /// Minor version of the file.
    #[must_use]
    pub fn minor(&self) -> u16 {
        self.minor
    }

    /// Bytes of the file, without what may follow it in memory.
    #[must_use]
    pub fn file(&self) -> &'a [u8] {
        self.file
    }

    /// Who made what, and from what: the section `meta`, which nothing else reads; empty where there is none.
    ///
    /// # Errors
    /// [`ReadError::Checksum`].
    pub fn metadata(&self) -> Result<Metadata<'a>, ReadError> {
        match self.section(Section::Metadata, Crc::Check) {
            Ok((_, bytes)) => Ok(Metadata::new(bytes)),
            Err(ReadError::Missing { .. }) => Ok(Metadata::new(&[])),
            Err(error) => Err(error),
        }
    }

    /// Entry and bytes of one section.
    ///
    /// # Errors
    /// [`ReadError::Missing`], or [`ReadError::Checksum`] where it is compared.
    pub fn section(&self, section: Section, crc: Crc) -> Result<(Entry, &'a [u8]), ReadError> {
        let entry = self.table.entry(section)?;
        let bytes = slice_at(self.file, entry.offset, entry.length).ok_or(ReadError::Missing { section })?;
        if crc == Crc::Check {
            let computed = crc32(bytes);
            if computed != entry.crc {
                return Err(ReadError::Checksum { section, stored: entry.crc, computed });
            }
        }
        Ok((entry, bytes))
    }
}
