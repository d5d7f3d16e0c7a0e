//! The container that all files share: header, section table, checksums (`FORMAT.md`, section 1).

use subsurf_decoder::Section;
use subsurf_decoder::container::{Container, Crc, ENTRY_BYTES, Entry, FILE_HEADER_BYTES, crc32, file_header};

use crate::error::{Error, Result};
use crate::file::reread::reread;

/// A file of these sections, in this order, each at a multiple of four bytes.
///
/// # Panics
/// If there are 2³² sections.
pub(crate) fn write<'a>(sections: impl IntoIterator<Item = (Section, &'a [u8])>) -> Vec<u8> {
    assemble(&sections.into_iter().map(|(section, bytes)| (section, bytes, crc32(bytes))).collect::<Vec<_>>())
}

/// A file of sections with their CRC-32.
fn assemble(all: &[(Section, &[u8], u32)]) -> Vec<u8> {
    let start = FILE_HEADER_BYTES + all.len() * ENTRY_BYTES + 4;
    let (mut table, mut body) = (Vec::new(), Vec::new());
    for (section, bytes, crc) in all {
        // Fill stands before a section, so that none follows the last.
        body.resize((start + body.len()).next_multiple_of(4) - start, 0);
        let (offset, length) = ((start + body.len()) as u64, bytes.len() as u64);
        table.extend(Entry { section: *section, crc: *crc, offset, length }.to_bytes());
        body.extend_from_slice(bytes);
    }
    let sections = u32::try_from(all.len()).expect("a handful of sections");
    let mut out = file_header(sections, (start + body.len()) as u64).to_vec();
    out.extend(table);
    out.extend(crc32(&out).to_le_bytes());
    out.extend(body);
    out
}

/// The same file with a section in place of the one of its kind, or behind the others but metadata; with none, without that kind. All others stay
/// as they are, those too that nobody reads or that are damaged.
///
/// # Errors
/// [`Error::Request`] if the bytes are no file; [`Error::OwnOutput`] if the decoder refuses the result.
pub(crate) fn with_section(file: &[u8], section: Section, bytes: Option<&[u8]>) -> Result<Vec<u8>> {
    let refuse = |error: subsurf_decoder::ReadError| Error::Request(error.to_string());
    let parsed = Container::parse(file).map_err(refuse)?;
    let mut sections = Vec::new();
    for entry in parsed.entries() {
        sections.push((entry.section, parsed.section(entry.section, Crc::Skip).map_err(refuse)?.1, entry.crc));
    }
    let old = sections.iter().position(|(kind, ..)| *kind == section);
    let last = sections.iter().position(|(kind, ..)| *kind == Section::Metadata).unwrap_or(sections.len());
    match (bytes.map(|bytes| (section, bytes, crc32(bytes))), old) {
        (Some(new), Some(old)) => sections[old] = new,
        (Some(new), None) => sections.insert(last, new),
        (None, Some(old)) => drop(sections.remove(old)),
        (None, None) => {}
    }
    reread(assemble(&sections))
}

/// Bytes of a file whose sections are this long.
pub(crate) fn file_bytes(lengths: &[u64]) -> u64 {
    let start = (FILE_HEADER_BYTES + lengths.len() * ENTRY_BYTES + 4) as u64;
    lengths.iter().fold(start, |end, length| end.next_multiple_of(4) + length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_come_back() {
        let contents: [&[u8]; 4] = [b"12345", b"", b"1234567", b"1"];
        let kinds = [*b"aaaa", *b"bbbb", *b"cccc", *b"dddd"].map(Section::from_kind);
        let file = write(kinds.into_iter().zip(contents));
        assert_eq!(file_bytes(&contents.map(|bytes| bytes.len() as u64)), file.len() as u64);
        let container = Container::parse(&file).unwrap();
        for (kind, bytes) in kinds.into_iter().zip(contents) {
            let (entry, found) = container.section(kind, Crc::Check).unwrap();
            assert_eq!((found, entry.offset % 4), (bytes, 0), "{kind}");
        }
    }
}
