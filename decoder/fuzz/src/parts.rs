//! A file as its sections: what mutation takes apart and puts together again.

use core::ops::Range;
use subsurf_decoder::Section;
use subsurf_decoder::container::{Container, ENTRY_BYTES, Entry, FILE_HEADER_BYTES, crc32, file_header};

/// Bytes of the CRC-32 of a header.
const CRC_BYTES: usize = size_of::<u32>();

/// Sections of a file in their order, and what follows the file.
pub(crate) struct Parts {
    pub(crate) sections: Vec<(Section, Vec<u8>)>,
    pub(crate) arguments: Vec<u8>,
}

impl Parts {
    /// Parts of an input whose container is sound.
    pub(crate) fn of(input: &[u8]) -> Option<Self> {
        let container = Container::parse(input).ok()?;
        let file = container.file();
        let sections = container.entries().map(|entry| {
            let [start, length] = [entry.offset, entry.length].map(|at| at as usize);
            (entry.section, file[start..start + length].to_vec())
        });
        Some(Self { sections: sections.collect(), arguments: input[file.len()..].to_vec() })
    }

    /// Bytes of the section of a kind, which is there afterwards.
    pub(crate) fn section(&mut self, section: Section) -> &mut Vec<u8> {
        let at = self.sections.iter().position(|(kind, _)| *kind == section).unwrap_or_else(|| {
            self.sections.push((section, Vec::new()));
            self.sections.len() - 1
        });
        &mut self.sections[at].1
    }

    /// Section at an offset of [`Self::to_bytes`], and where in it.
    pub(crate) fn at(&mut self, offset: u64) -> Option<&mut [u8]> {
        let mut start = self.header_bytes();
        for (_, bytes) in &mut self.sections {
            let end = start + bytes.len();
            if let Some(at) = (offset as usize).checked_sub(start).filter(|at| *at < bytes.len()) {
                return bytes.get_mut(at..);
            }
            start = end;
        }
        None
    }

    /// Length of [`Self::to_bytes`].
    pub(crate) fn len(&self) -> usize {
        self.header_bytes() + self.sections.iter().map(|(_, bytes)| bytes.len()).sum::<usize>() + self.arguments.len()
    }

    fn header_bytes(&self) -> usize {
        FILE_HEADER_BYTES + ENTRY_BYTES * self.sections.len() + CRC_BYTES
    }

    /// Input of these parts, whose checksums are right.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let (count, file_bytes) = (self.sections.len() as u32, (self.len() - self.arguments.len()) as u64);
        let mut input = Vec::with_capacity(self.len());
        input.extend(file_header(count, file_bytes));
        let mut offset = self.header_bytes() as u64;
        for (section, bytes) in &self.sections {
            let length = bytes.len() as u64;
            input.extend(Entry { section: *section, crc: crc32(bytes), offset, length }.to_bytes());
            offset += length;
        }
        input.extend(crc32(&input).to_le_bytes());
        for (_, bytes) in &self.sections {
            input.extend(bytes);
        }
        input.extend(&self.arguments);
        input
    }
}

/// Makes the checksum of section `number` right, which has the bytes of a range.
pub(crate) fn seal_section(input: &mut [u8], number: usize, range: Range<usize>) {
    /// Where an entry has the checksum.
    const CRC_AT: usize = 4;
    let crc = crc32(&input[range]).to_le_bytes();
    let at = FILE_HEADER_BYTES + ENTRY_BYTES * number + CRC_AT;
    input[at..at + CRC_BYTES].copy_from_slice(&crc);
}

/// Makes the checksum of the header right, where there is room for a header of as many sections as it says.
pub(crate) fn seal_header(input: &mut [u8]) {
    const SECTIONS: usize = 12;
    let Some(count) = input.get(SECTIONS..).and_then(|rest| rest.first_chunk()).map(|count| u32::from_le_bytes(*count))
    else {
        return;
    };
    let table_end = FILE_HEADER_BYTES + ENTRY_BYTES * count as usize;
    if let Some((covered, rest)) = input.split_at_mut_checked(table_end)
        && let Some(crc) = rest.first_chunk_mut()
    {
        *crc = crc32(covered).to_le_bytes();
    }
}
