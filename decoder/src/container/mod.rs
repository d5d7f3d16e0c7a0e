//! The container: file header, section table, CRC-32 (`FORMAT.md`, section 1).

pub mod bits;
pub mod bytes;
mod crc;
pub(crate) mod sections;

use crate::error::{ReadError, Section};
use bytes::{array_at, slice_at, u16_at, u32_at, u64_at};
pub use crc::crc32;

/// First eight bytes of every file.
pub const MAGIC: [u8; 8] = *b"\x89SSF\r\n\x1a\n";
/// Major version of the format; files with another one are refused.
pub const MAJOR: u16 = 1;
/// Minor version that is written.
pub const MINOR: u16 = 0;
/// Bytes before the section table.
pub const FILE_HEADER_BYTES: usize = 24;
/// Bytes of one section-table entry.
pub const ENTRY_BYTES: usize = 24;
/// Most sections that a file may have.
pub const MAX_SECTIONS: u32 = 64;

/// Whether to compare the CRC-32 of the sections that are read; the header's own is always compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crc {
    /// Compare.
    Check,
    /// Trust the storage. All other checks still run, so that any input stays harmless.
    Skip,
}

/// One entry of the section table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// What the section holds.
    pub section: Section,
    /// CRC-32 of its bytes.
    pub crc: u32,
    /// First byte, from the start of the file.
    pub offset: u64,
    /// Length in bytes.
    pub length: u64,
}

impl Entry {
    /// The entry as it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; ENTRY_BYTES] {
        let mut out = [0; ENTRY_BYTES];
        put(&mut out, 0, &self.section.kind());
        put(&mut out, 4, &self.crc.to_le_bytes());
        put(&mut out, 8, &self.offset.to_le_bytes());
        put(&mut out, 16, &self.length.to_le_bytes());
        out
    }

    fn from_bytes(bytes: &[u8; ENTRY_BYTES]) -> Option<Self> {
        Some(Self {
            section: Section::from_kind(array_at(bytes, 0)?),
            crc: u32_at(bytes, 4)?,
            offset: u64_at(bytes, 8)?,
            length: u64_at(bytes, 16)?,
        })
    }

    /// First byte after the section; saturates, so compare it before use.
    fn end(&self) -> u64 {
        self.offset.saturating_add(self.length)
    }
}

/// The file header as it stands in the file, for writers.
#[must_use]
pub fn file_header(sections: u32, file_bytes: u64) -> [u8; FILE_HEADER_BYTES] {
    let mut out = [0; FILE_HEADER_BYTES];
    put(&mut out, 0, &MAGIC);
    put(&mut out, 8, &MAJOR.to_le_bytes());
    put(&mut out, 10, &MINOR.to_le_bytes());
    put(&mut out, 12, &sections.to_le_bytes());
    put(&mut out, 16, &file_bytes.to_le_bytes());
    out
}

/// Copies `value` to `out[offset..]`; what does not fit stays out.
pub(crate) fn put(out: &mut [u8], offset: usize, value: &[u8]) {
    if let Some(place) = out.get_mut(offset..) {
        for (to, from) in place.iter_mut().zip(value) {
            *to = *from;
        }
    }
}

/// A file whose header and section table were checked.
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
    /// The first thing that is wrong, with where and the numbers.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ReadError> {
        let truncated = |need_bytes: u64| ReadError::Truncated {
            section: Section::FileHeader,
            need_bytes,
            have_bytes: bytes.len() as u64,
        };
        let at_start = truncated(FILE_HEADER_BYTES as u64);
        // A short file is told apart from another kind of file by what there is of the magic.
        let seen = bytes.get(..MAGIC.len()).unwrap_or(bytes);
        if !MAGIC.starts_with(seen) {
            return Err(ReadError::NotSubsurf);
        }
        let major = u16_at(bytes, 8).ok_or(at_start)?;
        let minor = u16_at(bytes, 10).ok_or(at_start)?;
        if major != MAJOR {
            return Err(ReadError::NewerVersion { major, minor });
        }
        let count = u32_at(bytes, 12).ok_or(at_start)?;
        if count == 0 || count > MAX_SECTIONS {
            return Err(ReadError::SectionCount { count, limit: MAX_SECTIONS });
        }
        let file_bytes = u64_at(bytes, 16).ok_or(at_start)?;
        let file = slice_at(bytes, 0, file_bytes).ok_or(truncated(file_bytes))?;

        let table_bytes = u64::from(count).saturating_mul(ENTRY_BYTES as u64);
        let table_end = table_bytes.saturating_add(FILE_HEADER_BYTES as u64);
        let header_end = table_end.saturating_add(4);
        let covered = slice_at(file, 0, table_end).ok_or(truncated(header_end))?;
        let stored = slice_at(file, table_end, 4).ok_or(truncated(header_end))?;
        let stored = u32_at(stored, 0).ok_or(truncated(header_end))?;
        let computed = crc32(covered);
        if stored != computed {
            return Err(ReadError::Checksum { section: Section::FileHeader, stored, computed });
        }
        let table = covered.get(FILE_HEADER_BYTES..).unwrap_or(&[]);
        let container = Self { file, table: table.as_chunks().0, minor };
        container.check_table(header_end)?;
        Ok(container)
    }

    /// Sections lie inside the file, in order, without overlap; no kind twice.
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
            earliest = entry.end();
        }
        Ok(())
    }

    /// The section table.
    pub fn entries(&self) -> impl Iterator<Item = Entry> + 'a {
        self.table.iter().filter_map(Entry::from_bytes)
    }

    /// Minor version of the file.
    #[must_use]
    pub fn minor(&self) -> u16 {
        self.minor
    }

    /// Length of the file in bytes, without what may follow it in memory.
    #[must_use]
    pub fn file_bytes(&self) -> usize {
        self.file.len()
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
