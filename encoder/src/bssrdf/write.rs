//! Fitted models to `.subsurf` files, through the decoder's own layout.

use subsurf_decoder::Section;
use subsurf_decoder::bssrdf::Header;
use subsurf_decoder::bssrdf::layout::MAX_LOG;
use subsurf_decoder::container::{ENTRY_BYTES, Entry, FILE_HEADER_BYTES, crc32, file_header};

/// A file of one material: container, header, and the sections of its model in file order.
///
/// # Panics
/// Never for the handful of sections that there are.
#[must_use]
pub fn write_file(header: &Header, sections: &[(Section, Vec<u8>)]) -> Vec<u8> {
    let header_section = (Section::BssrdfHeader, header.to_bytes().to_vec());
    let all: Vec<&(Section, Vec<u8>)> = std::iter::once(&header_section).chain(sections).collect();

    let mut offset = FILE_HEADER_BYTES + all.len() * ENTRY_BYTES + 4;
    let mut table = Vec::new();
    let mut body = Vec::new();
    for (section, bytes) in &all {
        let entry = Entry { section: *section, crc: crc32(bytes), offset: offset as u64, length: bytes.len() as u64 };
        table.extend(entry.to_bytes());
        body.extend_from_slice(bytes);
        body.resize(body.len().next_multiple_of(4), 0);
        offset += bytes.len().next_multiple_of(4);
    }
    // Nothing follows the last section: it needs no fill.
    let fill = all.last().map_or(0, |(_, bytes)| bytes.len().next_multiple_of(4) - bytes.len());
    body.truncate(body.len() - fill);

    let sections = u32::try_from(all.len()).expect("a handful of sections");
    let mut out = file_header(sections, (offset - fill) as u64).to_vec();
    out.extend(table);
    out.extend(crc32(&out).to_le_bytes());
    out.extend(body);
    out
}

/// Little-endian bytes of log-scale profile values, clamped to what the format allows.
pub(super) fn logs(values: impl Iterator<Item = f32>) -> Vec<u8> {
    values.flat_map(|value| value.clamp(-MAX_LOG, MAX_LOG).to_le_bytes()).collect()
}
