//! What every file begins with, checked: the file header, and the section table after it.

use super::crc::crc32;
use super::header::{ENTRY_BYTES, Entry, FILE_HEADER_BYTES, FileHeader, MAGIC, MAJOR, MAX_SECTIONS};
use super::record::Field;
use crate::error::ReadError;
use crate::section::Section;
use core::mem::offset_of;
use core::num::Saturating;

/// Checked file header: how much of everything follows it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    /// Minor version of the file.
    pub(crate) minor: u16,
    sections: u32,
    /// Length of the file.
    pub(crate) file_bytes: u64,
}

impl Start {
    /// Checks magic, version and number of sections in what there is of a file. One that is too short is told apart from another
    /// kind of file by what there is of the magic.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self, ReadError> {
        let seen = bytes.get(..MAGIC.len()).unwrap_or(bytes);
        if !MAGIC.starts_with(seen) {
            return Err(ReadError::NotSubsurf);
        }
        let FileHeader { major, minor, sections, file_bytes, .. } = FileHeader::from_bytes(bytes);
        let has = |end: usize| {
            if bytes.len() < end { Err(truncated(FILE_HEADER_BYTES as u64, bytes.len() as u64)) } else { Ok(()) }
        };
        has(offset_of!(FileHeader, sections))?;
        if major != MAJOR {
            return Err(ReadError::NewerVersion { major, minor });
        }
        has(offset_of!(FileHeader, file_bytes))?;
        if !(1..=MAX_SECTIONS).contains(&sections) {
            return Err(ReadError::SectionCount { count: sections, limit: MAX_SECTIONS });
        }
        has(FILE_HEADER_BYTES)?;
        Ok(Self { minor, sections, file_bytes })
    }

    /// First byte after the section table and the CRC of all before it; an error where the file ends before.
    pub(crate) fn header_end(&self) -> Result<usize, ReadError> {
        let [before, entry, sections] = [FILE_HEADER_BYTES, ENTRY_BYTES, self.sections as usize].map(Saturating);
        let end = (before + entry * sections + Saturating(size_of::<u32>())).0;
        if end as u64 > self.file_bytes { Err(truncated(end as u64, self.file_bytes)) } else { Ok(end) }
    }
}

/// Error of a file that ends too early.
pub(crate) fn truncated(need_bytes: u64, have_bytes: u64) -> ReadError {
    ReadError::Truncated { section: Section::FileHeader, need_bytes, have_bytes }
}

/// Section table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Table<'a>(&'a [[u8; ENTRY_BYTES]]);

impl<'a> Table<'a> {
    /// Checks the CRC of a file's first bytes, up to [`Start::header_end`], and the table in them: sections lie inside the file, in order,
    /// without overlap; no kind twice; none that must be understood and is not.
    pub(crate) fn parse(header: &'a [u8], start: &Start) -> Result<Self, ReadError> {
        let at_end = truncated(size_of::<u32>() as u64, header.len() as u64);
        let (covered, stored) = header.split_last_chunk().ok_or(at_end)?;
        let (stored, computed) = (u32::from_le_bytes(*stored), crc32(covered));
        if stored != computed {
            return Err(ReadError::Checksum { section: Section::FileHeader, stored, computed });
        }
        let table = Self::checked_before(header);
        let mut earliest = header.len() as u64;
        for (number, entry) in table.entries().enumerate() {
            let section = entry.section;
            if entry.offset < earliest {
                return Err(ReadError::Overlap { section, offset: entry.offset, earliest });
            }
            if entry.offset.checked_add(entry.length).is_none_or(|end| end > start.file_bytes) {
                let (need_bytes, have_bytes) = (entry.end(), start.file_bytes);
                return Err(ReadError::Truncated { section, need_bytes, have_bytes });
            }
            if table.entries().take(number).any(|before| before.section == section) {
                return Err(ReadError::Duplicate { section });
            }
            if matches!(section, Section::Other(_)) && section.is_critical() {
                return Err(ReadError::NewerSection { section });
            }
            earliest = entry.end();
        }
        Ok(table)
    }

    /// Table in a file's first bytes, which [`Self::parse`] has seen.
    pub(crate) fn checked_before(header: &'a [u8]) -> Self {
        Self(header.get(FILE_HEADER_BYTES..).unwrap_or(&[]).as_chunks().0)
    }

    /// Entries in file order.
    pub(crate) fn entries(self) -> impl Iterator<Item = Entry> + 'a {
        self.0.iter().map(Entry::from_bytes)
    }

    /// Entry of a section.
    pub(crate) fn entry(self, section: Section) -> Result<Entry, ReadError> {
        self.entries().find(|entry| entry.section == section).ok_or(ReadError::Missing { section })
    }

    /// Whether there is such a section.
    pub(crate) fn has(self, section: Section) -> bool {
        self.entry(section).is_ok()
    }
}
