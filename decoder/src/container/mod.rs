//! The container: file header, section table, CRC-32 (`FORMAT.md`, section 1), and how bytes become numbers.
//!
//! All offset arithmetic of the crate is here.

pub mod bits;
pub mod bytes;
mod crc;
mod header;
pub(crate) mod index;
mod metadata;
pub(crate) mod origin;
pub(crate) mod record;
pub(crate) mod sections;

pub use crc::crc32;
pub use header::{ENTRY_BYTES, Entry, FILE_HEADER_BYTES, MAGIC, MAJOR, MAX_SECTIONS, MINOR, file_header};
pub use metadata::{MAX_KEY_BYTES, MAX_VALUE_BYTES, Metadata, entry_header};

use crate::error::ReadError;
use crate::section::Section;
use bytes::slice_at;
use core::mem::offset_of;
use core::num::Saturating;
use header::FileHeader;
use record::Field;

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
    table: &'a [[u8; ENTRY_BYTES]],
    minor: u16,
}

impl<'a> Container<'a> {
    /// Checks magic, version, length, section table and the header's CRC.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place and the numbers.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ReadError> {
        let truncated = |need_bytes: u64| ReadError::Truncated {
            section: Section::FileHeader,
            need_bytes,
            have_bytes: bytes.len() as u64,
        };
        // A short file is told apart from another kind of file by what there is of the magic.
        let seen = bytes.get(..MAGIC.len()).unwrap_or(bytes);
        if !MAGIC.starts_with(seen) {
            return Err(ReadError::NotSubsurf);
        }
        let header = FileHeader::from_bytes(bytes);
        let has = |end: usize| if bytes.len() < end { Err(truncated(FILE_HEADER_BYTES as u64)) } else { Ok(()) };
        has(offset_of!(FileHeader, sections))?;
        let FileHeader { major, minor, sections, file_bytes, .. } = header;
        if major != MAJOR {
            return Err(ReadError::NewerVersion { major, minor });
        }
        has(offset_of!(FileHeader, file_bytes))?;
        if !(1..=MAX_SECTIONS).contains(&sections) {
            return Err(ReadError::SectionCount { count: sections, limit: MAX_SECTIONS });
        }
        has(FILE_HEADER_BYTES)?;
        let file = slice_at(bytes, 0, file_bytes).ok_or(truncated(file_bytes))?;

        let [before, entry] = [FILE_HEADER_BYTES, ENTRY_BYTES].map(|bytes| Saturating(bytes as u64));
        let table_end = before + entry * Saturating(sections.into());
        let header_end = table_end + Saturating(size_of::<u32>() as u64);
        let at_end = truncated(header_end.0);
        let (covered, stored) = slice_at(file, 0, header_end.0).and_then(<[u8]>::split_last_chunk).ok_or(at_end)?;
        let (stored, computed) = (u32::from_le_bytes(*stored), crc32(covered));
        if stored != computed {
            return Err(ReadError::Checksum { section: Section::FileHeader, stored, computed });
        }
        let table = covered.get(FILE_HEADER_BYTES..).unwrap_or(&[]);
        let container = Self { file, table: table.as_chunks().0, minor };
        container.check_table(header_end.0)?;
        Ok(container)
    }

    /// Sections lie inside the file, in order, without overlap; no kind twice; none that must be understood and is not.
    fn check_table(&self, header_end: u64) -> Result<(), ReadError> {
        let mut earliest = header_end;
        for (number, entry) in self.entries().enumerate() {
            let section = entry.section;
            if entry.offset < earliest {
                return Err(ReadError::Overlap { section, offset: entry.offset, earliest });
            }
            if slice_at(self.file, entry.offset, entry.length).is_none() {
                return Err(ReadError::Truncated {
                    section,
                    need_bytes: entry.end(),
                    have_bytes: self.file.len() as u64,
                });
            }
            if self.entries().take(number).any(|before| before.section == section) {
                return Err(ReadError::Duplicate { section });
            }
            if matches!(section, Section::Other(_)) && section.is_critical() {
                return Err(ReadError::NewerSection { section });
            }
            earliest = entry.end();
        }
        Ok(())
    }

    /// Entries of the section table, in file order.
    pub fn entries(&self) -> impl Iterator<Item = Entry> + 'a {
        self.table.iter().map(Entry::from_bytes)
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
        let missing = ReadError::Missing { section };
        let entry = self.entries().find(|entry| entry.section == section);
        let entry = entry.ok_or(missing)?;
        let bytes = slice_at(self.file, entry.offset, entry.length).ok_or(missing)?;
        if crc == Crc::Check {
            let computed = crc32(bytes);
            if computed != entry.crc {
                return Err(ReadError::Checksum { section, stored: entry.crc, computed });
            }
        }
        Ok((entry, bytes))
    }
}
