//! The example of `decoder/FORMAT.md`, section 7.3.

use subsurf_decoder::Section;
use subsurf_decoder::container::{ENTRY_BYTES, Entry, FILE_HEADER_BYTES, crc32, file_header};
use subsurf_decoder::transfer::TransferHeader;

/// The example of the specification.
///
/// # Panics
/// Never.
#[must_use]
pub fn format_transfer() -> Vec<u8> {
    let floats = |values: &[f32]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let triangles: Vec<u8> = [0_u32, 1, 2].iter().flat_map(|k| k.to_le_bytes()).collect();
    let mut bits = [0; 16];
    bits[..2].copy_from_slice(&[3, 2]);
    let header = TransferHeader {
        channels: 1,
        lights: 4,
        clusters: 2,
        tail_nodes: 2,
        vertices: 3,
        positions_crc: crc32(&floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0])),
        triangles_crc: crc32(&triangles),
        radius_mm: 2.0,
        eta: 1.5,
        scale: [0.5, 1.0, 1.0],
        bits,
    };
    let zeros = [0; 8];
    let sections = [
        (Section::TransferHeader, header.to_bytes().to_vec()),
        (Section::Lights, floats(&[1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0])),
        (Section::ClusterRanges, floats(&[0.0, 1.0 / 1024.0, -0.25, 0.125, 0.0, 0.125, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0])),
        (Section::ClusterMeans, [&[0, 4, 0, 2, 0, 1, 0, 0][..], &zeros].concat()),
        (Section::ClusterBases, [&[1, 0, 0xFF, 2, 0, 4, 0, 0][..], &zeros].concat()),
        (Section::VertexCodes, vec![0x00, 0x1C, 0x00, 0x00, 0x01, 0x00]),
        (Section::KernelTail, floats(&[49.0 / 64.0, 25.0 / 64.0, 0.25, 0.0, 0.0, 0.0])),
    ];
    let start = FILE_HEADER_BYTES + sections.len() * ENTRY_BYTES + 4;
    let (mut table, mut body) = (Vec::new(), Vec::new());
    for (section, bytes) in &sections {
        body.resize((start + body.len()).next_multiple_of(4) - start, 0);
        let (offset, length) = ((start + body.len()) as u64, bytes.len() as u64);
        table.extend(Entry { section: *section, crc: crc32(bytes), offset, length }.to_bytes());
        body.extend(bytes);
    }
    let count = u32::try_from(sections.len()).expect("seven");
    let mut file = file_header(count, (start + body.len()) as u64).to_vec();
    file.extend(table);
    file.extend(crc32(&file).to_le_bytes());
    file.extend(body);
    file
}
