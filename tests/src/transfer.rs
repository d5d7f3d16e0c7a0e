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
        axes: 2,
    };
    let sections = [
        (Section::TransferHeader, header.to_bytes().to_vec()),
        (Section::Lights, floats(&[1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0])),
        (Section::LightAxes, vec![0x01, 0x00, 0x00, 0x01, 0x01, 0x01, 0x02, 0xFF]),
        (Section::ClusterRanges, floats(&[0.0, 1.0 / 1024.0, -0.25, 0.125, 0.0, 0.125, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0])),
        (Section::ClusterMeans, vec![0, 4, 0, 2, 0, 0, 0, 0]),
        (Section::ClusterBases, vec![1, 0, 0xFF, 4, 0, 0, 0, 0]),
        (Section::VertexCodes, vec![0x00, 0x1C, 0x00, 0x00, 0x01, 0x00]),
        (Section::KernelTail, floats(&[49.0 / 64.0, 25.0 / 64.0, 0.25, 0.0, 0.0, 0.0])),
    ];
    write(&sections)
}

/// Three channels, seven lights, four axes, three clusters of five components in 33 bits, eleven vertices: numbers from formulas.
///
/// # Panics
/// Never.
#[must_use]
pub fn rgb_transfer() -> Vec<u8> {
    let floats = |values: &[f32]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let number = |k: usize, most: usize| u8::try_from(k * 37 % 251 % most).expect("a byte");
    let real = |k: usize| f32::from(number(k, 200)) / 100.0 - 1.0;
    let mut bits = [0; 16];
    bits[..5].copy_from_slice(&[12, 9, 6, 4, 2]);
    let header = TransferHeader {
        channels: 3,
        lights: 7,
        clusters: 3,
        tail_nodes: 3,
        vertices: 11,
        positions_crc: 1,
        triangles_crc: 2,
        radius_mm: 4.0,
        eta: 1.3,
        scale: [0.5, 0.25, 2.0],
        bits,
        axes: 4,
    };
    let directions = (0..7).flat_map(|k| {
        let direction = [real(3 * k), real(3 * k + 1), real(3 * k + 2)];
        let length = direction.iter().map(|x| x * x).sum::<f32>().sqrt();
        direction.map(|x| x / length)
    });
    // Offset and step of the mean, then of each component; steps fall as bits rise.
    let steps = [1.0 / 65_536.0, 1e-4, 1e-3, 5e-3, 2e-2, 0.1];
    let ranges = (0..18).flat_map(|k| [0.1 * real(k), steps[k % 6]]);
    let codes = (0..11).flat_map(|vertex| {
        (0..6).map(move |at| if at == 0 { number(vertex, 3) } else { number(7 * vertex + at, 256) })
    });
    write(&[
        (Section::TransferHeader, header.to_bytes().to_vec()),
        (Section::Lights, floats(&directions.collect::<Vec<f32>>())),
        (Section::LightAxes, (0..3 * 7 * 4).map(|k| number(k + 5, 256)).collect()),
        (Section::ClusterRanges, floats(&ranges.collect::<Vec<f32>>())),
        (Section::ClusterMeans, (0..2 * 3 * 4).map(|k| number(k, 256)).collect()),
        (Section::ClusterBases, (0..3 * 5 * 4).map(|k| number(k, 256)).collect()),
        (Section::VertexCodes, codes.collect()),
        (Section::KernelTail, floats(&[0.75, 0.5, 0.25, 0.5, 0.125, 0.25, 0.0, 0.0, 0.0])),
    ])
}

/// File of sections, by the decoder's own layout alone.
fn write(sections: &[(Section, Vec<u8>)]) -> Vec<u8> {
    let start = FILE_HEADER_BYTES + sections.len() * ENTRY_BYTES + 4;
    let (mut table, mut body) = (Vec::new(), Vec::new());
    for (section, bytes) in sections {
        body.resize((start + body.len()).next_multiple_of(4) - start, 0);
        let (offset, length) = ((start + body.len()) as u64, bytes.len() as u64);
        table.extend(Entry { section: *section, crc: crc32(bytes), offset, length }.to_bytes());
        body.extend(bytes);
    }
    let count = u32::try_from(sections.len()).expect("a few");
    let mut file = file_header(count, (start + body.len()) as u64).to_vec();
    file.extend(table);
    file.extend(crc32(&file).to_le_bytes());
    file.extend(body);
    file
}
