//! Writes a file with nothing but the decoder's records: a patch of 229 × 229 pixels, two base materials in stripes that melt into each other.
//!
//! `cargo run --example patch -- FILE`; without a file it only says what it would write.

use std::error::Error;
use subsurf_decoder::bssrdf::layout::MODEL_2BMPP;
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader, Coding};
use subsurf_decoder::container::{ENTRY_BYTES, Entry, FILE_HEADER_BYTES, crc32, file_header};
use subsurf_decoder::{File, Section};

const SIDE: u16 = 229;
const SAMPLES: u16 = 22;
const RADIUS: u16 = 20;
const PITCH_MM: f32 = 0.1;
const R_MAX_MM: f32 = 2.0;

/// Base scattering profile exp(−r / length) / (2π length r) of albedo `albedo` at a node, as its natural logarithm.
fn log_profile(albedo: f32, length_mm: f32, h: u16) -> f32 {
    let r_mm = (f32::from(h) * R_MAX_MM / f32::from(SAMPLES - 1)).max(0.5 * PITCH_MM);
    (albedo / (std::f32::consts::TAU * length_mm * r_mm)).ln() - r_mm / length_mm
}

fn main() -> Result<(), Box<dyn Error>> {
    let header = BssrdfHeader {
        model: MODEL_2BMPP,
        coding: Coding::Exact,
        addressing: Addressing::Clamp,
        width: SIDE.into(),
        height: SIDE.into(),
        window_radius: RADIUS,
        samples: SAMPLES,
        base_materials: 2,
        pitch_mm: PITCH_MM,
        r_max_mm: R_MAX_MM,
        eta: 1.4,
    };
    // Wax, warm and far; stone, cold and near.
    let materials = [([0.8, 0.6, 0.3], 0.4), ([0.2, 0.3, 0.5], 0.15)];
    let profiles = materials.iter().flat_map(|(albedo, length_mm)| {
        (0..SAMPLES).flat_map(|h| albedo.map(|albedo| log_profile(albedo, *length_mm, h)))
    });
    let pixels = || (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| [x, y].map(f32::from)));
    let ratios = pixels().map(|[x, y]| 0.5 + 0.5 * (0.05 * x + 0.02 * y).sin());
    let bytes_of = |numbers: Vec<f32>| numbers.into_iter().flat_map(f32::to_le_bytes).collect::<Vec<u8>>();
    let sections = [
        (Section::BssrdfHeader, header.to_bytes().to_vec()),
        (Section::BaseProfiles, bytes_of(profiles.collect())),
        (Section::MixtureRatios, bytes_of(ratios.collect())),
        (Section::BaseIndices, pixels().flat_map(|_| [0, 1]).collect()),
    ];

    let start = FILE_HEADER_BYTES + ENTRY_BYTES * sections.len() + size_of::<u32>();
    let bytes = start + sections.iter().map(|(_, bytes)| bytes.len()).sum::<usize>();
    let mut file = file_header(u32::try_from(sections.len())?, bytes as u64).to_vec();
    let mut offset = start as u64;
    for (section, bytes) in &sections {
        let entry = Entry { section: *section, crc: crc32(bytes), offset, length: bytes.len() as u64 };
        file.extend(entry.to_bytes());
        offset += entry.length;
    }
    file.extend(crc32(&file).to_le_bytes());
    file.extend(sections.into_iter().flat_map(|(_, bytes)| bytes));
    File::parse(&file)?;
    println!("{SIDE} × {SIDE} pixels in {} bytes", file.len());
    if let Some(path) = std::env::args().nth(1) {
        std::fs::write(path, file)?;
    }
    Ok(())
}
