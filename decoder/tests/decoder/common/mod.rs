//! The example of `FORMAT.md`, section 3, built from literals: nothing here uses the crate's own layout.
#![cfg_attr(
    not(all(feature = "alloc", feature = "push", feature = "transfer")),
    allow(dead_code, reason = "some helpers serve only tests behind features")
)]

pub(crate) mod btf;
pub(crate) mod damage;
#[cfg(feature = "push")]
pub(crate) mod push;

use subsurf_decoder::Section;
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader, Coding};
use subsurf_decoder::container::{Container, Crc};

/// Offsets in the example file, straight from the specification.
pub(crate) const MODEL: usize = 124;
pub(crate) const WIDTH: usize = 128;
pub(crate) const SAMPLES: usize = 138;
pub(crate) const PITCH: usize = 144;
pub(crate) const PROF: usize = 156;
pub(crate) const MIXR: usize = 204;
pub(crate) const BIDX: usize = 212;

/// P̂_0 and P̂_1, two nodes of rgb each.
pub(crate) const PROFILES: [f32; 12] = [
    -1.0, -2.0, -3.0, -2.0, -4.0, -6.0, // material 0
    -3.0, -2.0, -1.0, -5.0, -5.0, -5.0, // material 1
];

/// Bitwise CRC-32 of IEEE 802.3, to check the table-driven one against.
pub(crate) fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg()))
    })
}

/// Recomputes every CRC of a file with four sections.
pub(crate) fn seal(file: &mut [u8]) {
    seal_all(file, 4);
}

/// Recomputes every CRC of a file.
pub(crate) fn seal_all(file: &mut [u8], sections: usize) {
    for entry in (0..sections).map(|k| 24 + 24 * k) {
        let read = |at: usize| u64::from_le_bytes(file[at..at + 8].try_into().unwrap());
        let offset = usize::try_from(read(entry + 8)).ok();
        let end = read(entry + 8).checked_add(read(entry + 16));
        let end = end.and_then(|end| usize::try_from(end).ok());
        let bytes = offset.zip(end).and_then(|(offset, end)| file.get(offset..end));
        let crc = crc32(bytes.unwrap_or(&[]));
        file[entry + 4..entry + 8].copy_from_slice(&crc.to_le_bytes());
    }
    let end = 24 + 24 * sections;
    let crc = crc32(&file[..end]);
    file[end..end + 4].copy_from_slice(&crc.to_le_bytes());
}

/// File header of version 1.0 and table of sections, each a kind, an offset and a length; CRCs are 0.
pub(crate) fn begin<const N: usize>(file_bytes: u16, sections: [(&[u8; 4], u64, u64); N]) -> Vec<u8> {
    let [low, high] = file_bytes.to_le_bytes();
    let count = u8::try_from(N).unwrap();
    let mut file = vec![
        0x89, 0x53, 0x53, 0x46, 0x0D, 0x0A, 0x1A, 0x0A, // magic
        0x01, 0x00, 0x00, 0x00, // version 1.0
        count, 0x00, 0x00, 0x00, // sections
        low, high, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    ];
    for (kind, offset, length) in sections {
        file.extend(kind);
        file.extend([0; 4]);
        file.extend(offset.to_le_bytes());
        file.extend(length.to_le_bytes());
    }
    file.extend([0; 4]); // header_crc
    file
}

/// The 216 bytes.
#[rustfmt::skip]
pub(crate) fn example() -> Vec<u8> {
    let mut file = begin(0xD8, [(b"BSSR", 124, 32), (b"PROF", 156, 48), (b"MIXR", 204, 8), (b"BIDX", 212, 4)]);
    file.extend([
        0x02, 0x01, 0x00, 0x00,                          // model, colour space, addressing, reserved
        0x02, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00,  // width, height
        0x01, 0x00, 0x02, 0x00,                          // R, S
        0x02, 0x00, 0x00, 0x00,                          // M
        0x00, 0x00, 0x00, 0x3F,                          // pitch 0.5
        0x00, 0x00, 0x80, 0x3F,                          // r_max 1.0
        0x00, 0x00, 0xC0, 0x3F,                          // eta 1.5
    ]);
    file.extend(PROFILES.iter().flat_map(|value| value.to_le_bytes()));
    file.extend([
        0x00, 0x00, 0x80, 0x3F, 0x00, 0x00, 0x80, 0x3E,  // t = 1.0, 0.25
        0x00, 0x01, 0x01, 0x00,                          // (0, 1), (1, 0)
    ]);
    seal(&mut file);
    file
}

/// The example with one more section behind the others; its CRC is 0.
pub(crate) fn with_section(kind: &[u8; 4], section: &[u8]) -> Vec<u8> {
    let mut file = example();
    file[12] = 5;
    let mut entry = kind.to_vec();
    entry.extend([0; 4]);
    entry.extend((216_u64 + 24).to_le_bytes());
    entry.extend((section.len() as u64).to_le_bytes());
    file.splice(120..120, entry);
    for k in 0..4 {
        file[24 + 24 * k + 8] += 24;
    }
    file.extend(section);
    let bytes = file.len() as u64;
    file[16..24].copy_from_slice(&bytes.to_le_bytes());
    let crc = crc32(&file[..144]);
    file[144..148].copy_from_slice(&crc.to_le_bytes());
    file
}

/// File of sections with their bytes, each at a multiple of four bytes.
pub(crate) fn container(sections: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
    let mut file = vec![0x89, 0x53, 0x53, 0x46, 0x0D, 0x0A, 0x1A, 0x0A, 0x01, 0x00, 0x00, 0x00];
    file.extend(u32::try_from(sections.len()).unwrap().to_le_bytes());
    let mut end = 28 + 24 * sections.len();
    let offsets: Vec<usize> = sections
        .iter()
        .map(|(_, bytes)| {
            let offset = end.next_multiple_of(4);
            end = offset + bytes.len();
            offset
        })
        .collect();
    file.extend((end as u64).to_le_bytes());
    for ((kind, bytes), offset) in sections.iter().zip(&offsets) {
        file.extend(*kind);
        file.extend([0; 4]);
        file.extend([*offset, bytes.len()].into_iter().flat_map(|number| (number as u64).to_le_bytes()));
    }
    for ((_, bytes), offset) in sections.iter().zip(&offsets) {
        file.resize(*offset, 0);
        file.extend(bytes);
    }
    // A header ends with its CRC where there are no sections, too.
    file.resize(end, 0);
    seal_all(&mut file, sections.len());
    file
}

/// [`container`] of borrowed sections.
pub(crate) fn assemble(sections: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    container(&sections.iter().map(|(kind, bytes)| (*kind, bytes.to_vec())).collect::<Vec<_>>())
}

/// Numbers as they stand in a file.
pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Header of the example.
pub(crate) const HEADER: BssrdfHeader = BssrdfHeader {
    model: 2,
    coding: Coding::Exact,
    addressing: Addressing::Clamp,
    width: 2,
    height: 1,
    window_radius: 1,
    samples: 2,
    base_materials: 2,
    pitch_mm: 0.5,
    r_max_mm: 1.0,
    eta: 1.5,
};

/// BSSRDF of a header and the sections after it.
pub(crate) fn bssrdf(header: BssrdfHeader, sections: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let header = header.to_bytes();
    assemble(&[&[(b"BSSR", &header[..])], sections].concat())
}

/// File with other sections.
pub(crate) fn rebuilt(bytes: &[u8], change: impl FnOnce(&mut Vec<([u8; 4], Vec<u8>)>)) -> Vec<u8> {
    let file = Container::parse(bytes).unwrap();
    let content = |section: Section| file.section(section, Crc::Skip).unwrap().1.to_vec();
    let mut sections = file.entries().map(|entry| (entry.section.kind(), content(entry.section))).collect();
    change(&mut sections);
    container(&sections.iter().map(|(kind, bytes)| (kind, bytes.clone())).collect::<Vec<_>>())
}

/// First byte and length of a section.
pub(crate) fn place(bytes: &[u8], section: Section) -> (usize, usize) {
    let container = Container::parse(bytes).unwrap();
    let entry = container.entries().find(|entry| entry.section == section).expect("the section");
    (usize::try_from(entry.offset).unwrap(), usize::try_from(entry.length).unwrap())
}
