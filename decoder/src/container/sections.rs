//! The sections of one file by kind and size.

use super::origin::Origin;
use super::{Container, Crc, Entry};
use crate::error::ReadError;
use crate::section::Section;

/// Sections of a file, with the choice about their checksums.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sections<'a> {
    pub(crate) container: Container<'a>,
    crc: Crc,
}

/// Bytes of one section, and where they stand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SectionBytes<'a> {
    pub(crate) origin: Origin,
    pub(crate) bytes: &'a [u8],
}

impl<'a> Sections<'a> {
    /// Checks header and section table of a file.
    pub(crate) fn parse(bytes: &'a [u8], crc: Crc) -> Result<Self, ReadError> {
        Ok(Self { container: Container::parse(bytes)?, crc })
    }

    /// Whether there is such a section.
    pub(crate) fn has(&self, section: Section) -> bool {
        self.container.table.has(section)
    }

    /// A section of any size.
    pub(crate) fn any(&self, section: Section) -> Result<SectionBytes<'a>, ReadError> {
        let (Entry { offset, .. }, bytes) = self.container.section(section, self.crc)?;
        Ok(SectionBytes { origin: Origin { section, offset }, bytes })
    }

    /// A section that must have `need_bytes`.
    #[inline(never)]
    pub(crate) fn sized(&self, section: Section, need_bytes: u64) -> Result<SectionBytes<'a>, ReadError> {
        self.any(section)?.sized(need_bytes)
    }
}

impl<'a> SectionBytes<'a> {
    /// The section if it has `need_bytes`.
    pub(crate) fn sized(self, need_bytes: u64) -> Result<Self, ReadError> {
        if self.bytes.len() as u64 == need_bytes { Ok(self) } else { Err(self.wrong_size(need_bytes)) }
    }

    /// The section if it has `need_bytes` or more: headers grow at their end from one minor version to the next.
    pub(crate) fn at_least(self, need_bytes: u64) -> Result<Self, ReadError> {
        if self.bytes.len() as u64 >= need_bytes { Ok(self) } else { Err(self.wrong_size(need_bytes)) }
    }

    /// Error of a section that must have another size.
    pub(crate) fn wrong_size(self, need_bytes: u64) -> ReadError {
        let have_bytes = self.bytes.len() as u64;
        ReadError::WrongSize { section: self.origin.section, need_bytes, have_bytes }
    }

    /// What the section has from byte `at` on.
    pub(crate) fn from(self, at: usize) -> Self {
        Self { origin: self.origin.at(at), bytes: self.bytes.get(at..).unwrap_or(&[]) }
    }
}
