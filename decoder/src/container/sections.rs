//! Sections of a BTF file by kind and size.

use super::{Container, Crc};
use crate::error::{ReadError, Section};

/// The sections of one file.
pub(crate) struct Sections<'a, 'b> {
    pub(crate) container: &'b Container<'a>,
    pub(crate) crc: Crc,
}

impl<'a> Sections<'a, '_> {
    /// Offset in the file and bytes of a section of any size.
    pub(crate) fn any(&self, section: Section) -> Result<(u64, &'a [u8]), ReadError> {
        let (entry, bytes) = self.container.section(section, self.crc)?;
        Ok((entry.offset, bytes))
    }

    /// Bytes of a section that must have `need_bytes`.
    pub(crate) fn sized(&self, section: Section, need_bytes: u64) -> Result<&'a [u8], ReadError> {
        let (_, bytes) = self.any(section)?;
        let have_bytes = bytes.len() as u64;
        if have_bytes == need_bytes { Ok(bytes) } else { Err(ReadError::WrongSize { section, need_bytes, have_bytes }) }
    }

    /// Where a section begins in the file, to say where something is wrong in it.
    pub(crate) fn start(&self, section: Section) -> u64 {
        self.container.entries().find(|entry| entry.section == section).map_or(0, |entry| entry.offset)
    }
}
