//! File header and section table (`FORMAT.md`, section 1).

use super::record::{Field, record};
use crate::section::Section;

/// First eight bytes of every file.
pub const MAGIC: [u8; 8] = *b"\x89SSF\r\n\x1a\n";
/// Major version of the format; files with another one are refused.
pub const MAJOR: u16 = 1;
/// Minor version that is written.
pub const MINOR: u16 = 0;
/// Bytes before the section table.
pub const FILE_HEADER_BYTES: usize = size_of::<FileHeader>();
/// Bytes of one section-table entry.
pub const ENTRY_BYTES: usize = size_of::<EntryRecord>();
/// Largest number of sections in a file.
pub const MAX_SECTIONS: u32 = 64;

record! {
    /// What every file begins with.
    FileHeader {
        magic: [u8; 8],
        major: u16,
        minor: u16,
        sections: u32,
        file_bytes: u64,
    }
}

record! {
    /// An entry of the section table.
    EntryRecord {
        kind: [u8; 4],
        crc: u32,
        offset: u64,
        length: u64,
    }
}

/// File header as it stands in the file, for writers: number of sections, and length of the file in bytes.
#[must_use]
pub fn file_header(sections: u32, file_bytes: u64) -> [u8; FILE_HEADER_BYTES] {
    FileHeader { magic: MAGIC, major: MAJOR, minor: MINOR, sections, file_bytes }.to_bytes()
}

/// Entry of the section table: kind, place and checksum of one section.
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
    /// Entry as it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; ENTRY_BYTES] {
        let Self { section, crc, offset, length } = *self;
        EntryRecord { kind: section.kind(), crc, offset, length }.to_bytes()
    }

    /// Entry from the file.
    pub(crate) fn from_bytes(bytes: &[u8; ENTRY_BYTES]) -> Self {
        let EntryRecord { kind, crc, offset, length } = EntryRecord::from_bytes(bytes);
        Self { section: Section::from_kind(kind), crc, offset, length }
    }

    /// First byte after the section; saturates, so compare it before use.
    pub(crate) fn end(&self) -> u64 {
        self.offset.saturating_add(self.length)
    }
}
