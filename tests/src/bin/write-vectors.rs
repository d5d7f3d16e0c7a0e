//! Writes `tests/vectors/` anew: small files of every kind with tables of what they hold, and broken ones with the error that is due.

use std::fmt::Write as _;
use std::path::Path;

use subsurf_decoder::bssrdf::{Addressing, Coding};
use subsurf_decoder::btf::ColourEncoding;
use subsurf_decoder::container::{Container, crc32};
use subsurf_encoder::bssrdf::basis::{FittedBasis, with_basis};
use subsurf_encoder::synthetic::{NestedShape, Shape, factored};
use subsurf_encoder::with_metadata;
use subsurf_tests::kernels::{difference, format_kernel, skin};
use subsurf_tests::nested::ODD_GRID;
use subsurf_tests::transfer::{format_transfer, rgb_transfer};
use subsurf_tests::vectors::table;
use subsurf_tests::{format_basis, format_example, shape};

fn main() -> std::io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("vectors");
    // What is not written any more shall not stay.
    for entry in std::fs::read_dir(&folder)? {
        std::fs::remove_file(entry?.path())?;
    }
    let mut refused = String::from("file,error\n");
    let mut write = |name: &str, bytes: &[u8]| -> std::io::Result<()> {
        std::fs::write(folder.join(format!("{name}.subsurf")), bytes)?;
        match table(bytes) {
            Ok(table) => std::fs::write(folder.join(format!("{name}.csv")), table)?,
            // Writing to a string cannot fail.
            Err(error) => _ = writeln!(refused, "{name}.subsurf,\"{error}\""),
        }
        Ok(())
    };

    let example = format_example();
    write("format_example", &example)?;
    let odd = |addressing| shape([7, 5], 3, addressing);
    write("bmpp_clamp", &odd(Addressing::Clamp).bmpp())?;
    write("bmpp_repeat", &odd(Addressing::Repeat).bmpp())?;
    write("bmpp_mirror", &odd(Addressing::Mirror).bmpp())?;
    write("per_pixel_clamp", &odd(Addressing::Clamp).per_pixel())?;
    let clamp = odd(Addressing::Clamp);
    write("one_base", &clamp.k_bmpp(1, Coding::Exact, false))?;
    write("one_of_300_bases", &Shape { base_materials: 300, ..clamp }.k_bmpp(1, Coding::Exact, false))?;
    write("three_bases", &clamp.k_bmpp(3, Coding::Exact, false))?;
    write("five_bases", &clamp.k_bmpp(5, Coding::Exact, false))?;
    write("small_ratios", &clamp.k_bmpp(2, Coding::SmallRatios, false))?;
    write("palette", &clamp.k_bmpp(2, Coding::Palette, false))?;
    write("half_profiles", &clamp.k_bmpp(2, Coding::Exact, true))?;
    let one = Shape { size: [1, 1], radius: 0, samples: 2, base_materials: 1, addressing: Addressing::Clamp };
    write("one_pixel", &one.bmpp())?;
    let full = Shape { base_materials: 255, ..shape([16, 16], 2, Addressing::Repeat) };
    write("many_bases", &full.bmpp())?;
    let based = with_basis(&example, &format_basis()).expect("a basis in range");
    write("separable_basis", &based)?;

    let kernel = format_kernel().to_bytes().expect("a kernel in range");
    write("kernel_example", &kernel)?;
    write("kernel_two_gaussians", &skin(17).to_bytes().expect("a kernel in range"))?;
    write("kernel_two_terms", &difference(11).to_bytes().expect("a kernel in range"))?;

    let transfer = format_transfer();
    write("transfer_example", &transfer)?;
    write("transfer_rgb", &rgb_transfer())?;

    // Both encodings, with all that nested codebooks may have; several materials with mipmaps.
    let relative = NestedShape { is_relative: true, ..NestedShape::small() };
    let nested = relative.database(1).to_bytes();
    write("nested_display", &nested)?;
    let tone = ColourEncoding::Display { white: 2.5 };
    let tinted = NestedShape { tone, tints: 5, scale_bits: 10, ..NestedShape::small() };
    write("nested_tints", &tinted.database(2).to_bytes())?;
    let tone = ColourEncoding::LogLuv { toe: 0.01, peak: 50.0 };
    let staged = NestedShape { tone, stages: 3, grid: ODD_GRID, ..NestedShape::small() };
    write("nested_log_luv_stages", &staged.database(3).to_bytes())?;
    let several = NestedShape { materials: vec![(4, 3, 3), (1, 1, 1), (2, 5, 2)], stages: 2, tints: 2, ..relative };
    write("nested_materials", &several.database(4).to_bytes())?;
    let mut sized = several.database(5);
    sized.header.texel_mm = Some(0.25);
    write("nested_texel_size", &sized.to_bytes())?;
    let factors = factored(1);
    write("factored", &factors)?;
    write("factored_stages", &factored(3))?;

    // What later versions may do, and what a reader must not stumble over.
    let minor = |mut file: Vec<u8>| {
        file[10] = 9;
        reseal(file)
    };
    write("newer_minor", &minor(example.clone()))?;
    write("skipped_section", &minor(with_section(&example, b"xtra", b"not known")))?;
    write("other_order", &other_order(&example))?;
    write("trailing_bytes", &[&example[..], &[0xFF; 37]].concat())?;
    write("longer_header", &minor(longer_header(&example)))?;
    let entries = [("name", "example"), ("author", "Dëmo"), ("licence", "CC0-1.0")];
    let entries = entries.map(|(key, value)| (key.to_owned(), value.to_owned()));
    write("metadata", &with_metadata(&example, &entries).expect("short texts"))?;
    write("x_newer_section", &minor(with_section(&example, b"XTRA", b"not known")))?;
    write("x_two_families", &with_section(&example, b"KERN", &kernel[124..148]))?;
    write("x_no_family", &with_kind(&example, 0, b"none"))?;

    // Broken, each in one way.
    let broken = |at: usize, value: u8| {
        let mut bytes = example.clone();
        bytes[at] = value;
        bytes
    };
    write("x_magic", &broken(1, b'X'))?;
    write("x_newer_major", &reseal(broken(8, 2)))?;
    write("x_header_crc", &broken(120, example[120] ^ 1))?;
    write("x_profile_crc", &broken(156, example[156] ^ 1))?;
    write("x_cut", &example[..example.len() - 1])?;
    write("x_model", &reseal(broken(124, 9)))?;
    write("x_index", &reseal(broken(213, 2)))?;
    write("x_ratio", &reseal(broken(207, 0x40)))?;
    write("x_profile_infinite", &reseal(broken(159, 0xFF)))?;
    write("x_overlap", &reseal(broken(24 + 24 + 8, 150)))?;
    let wrong = |change: &dyn Fn(&mut FittedBasis)| {
        let mut basis = format_basis();
        change(&mut basis);
        // Written as the writer would, which reads it again: so by hand, over a sound one.
        let mut file = based.clone();
        let start = file.len() - basis.to_bytes().len();
        file.truncate(start);
        file.extend(basis.to_bytes());
        reseal(file)
    };
    write("x_basis_width", &wrong(&|basis| basis.sigmas[0] = 0.0))?;
    write("x_basis_widths_fall", &wrong(&|basis| basis.sigmas[1] = 0.25))?;
    write("x_basis_nan", &wrong(&|basis| basis.weights[3][1] = f32::NAN))?;
    write("x_basis_huge", &wrong(&|basis| basis.projection[2][0] = 2e15))?;
    write("x_basis_terms", &wrong(&|basis| basis.size.terms = 3))?;
    let wrong = |at: usize, value: &[u8]| {
        let mut bytes = kernel.clone();
        bytes[at..at + value.len()].copy_from_slice(value);
        reseal(bytes)
    };
    write("x_kernel_method", &wrong(124, &[6]))?;
    write("x_kernel_taps_even", &wrong(127, &[4]))?;
    write("x_kernel_signs", &wrong(132, &[8]))?;
    write("x_kernel_offset_first", &wrong(148, &0.25_f32.to_le_bytes()))?;
    write("x_kernel_offsets_fall", &wrong(156, &0.5_f32.to_le_bytes()))?;
    write("x_kernel_offset_radius", &wrong(156, &2.0_f32.to_le_bytes()))?;
    write("x_kernel_weight_nan", &wrong(172, &f32::NAN.to_le_bytes()))?;
    write("x_kernel_energy", &wrong(172, &0.25_f32.to_le_bytes()))?;
    write("x_kernel_tail_rises", &wrong(208, &0.8_f32.to_le_bytes()))?;
    write("x_kernel_tail_end", &wrong(220, &0.125_f32.to_le_bytes()))?;
    let wrong = |at: usize, value: &[u8]| {
        let mut bytes = transfer.clone();
        bytes[at..at + value.len()].copy_from_slice(value);
        reseal(bytes)
    };
    write("x_transfer_channels", &wrong(221, &[2]))?;
    write("x_transfer_bits", &wrong(263, &[1]))?;
    write("x_transfer_record", &wrong(260, &[12; 16]))?;
    write("x_transfer_axes", &wrong(276, &257_u16.to_le_bytes()))?;
    write("x_transfer_light", &wrong(280, &0.5_f32.to_le_bytes()))?;
    write("x_transfer_step", &wrong(340, &(-0.5_f32).to_le_bytes()))?;
    write("x_transfer_cluster", &wrong(402, &[2]))?;
    write("x_transfer_tail", &wrong(408, &1.5_f32.to_le_bytes()))?;
    let of = |file: &[u8], kind: &[u8; 4]| {
        let container = Container::parse(file).expect("a sound file");
        let entry = container.entries().find(|entry| entry.section.kind() == *kind).expect("such a section");
        usize::try_from(entry.offset).expect("a small file")
    };
    let wrong = |file: &[u8], kind: &[u8; 4], at: usize, value: &[u8]| {
        let mut bytes = file.to_vec();
        let at = of(file, kind) + at;
        bytes[at..at + value.len()].copy_from_slice(value);
        reseal(bytes)
    };
    write("x_btf_model", &wrong(&nested, b"BTFH", 0, &[3]))?;
    write("x_btf_nodes", &wrong(&nested, b"BTFH", 4, &[1]))?;
    write("x_btf_texel_size", &wrong(&nested, b"BTFH", 32, &(-1.0_f32).to_le_bytes()))?;
    write("x_btf_width", &wrong(&nested, b"MATS", 24, &[0, 0]))?;
    write("x_nested_entries", &wrong(&nested, b"BOOK", 0, &[0; 4]))?;
    write("x_nested_relative", &wrong(&nested, b"BOOK", 36, &[2]))?;
    write("x_nested_scale", &wrong(&nested, b"BOOK", 40 + 5, &[7]))?;
    write("x_nested_signed", &wrong(&nested, b"BOOK", 40 + 36, &[1]))?;
    write("x_nested_index", &wrong(&nested, b"P4S0", 0, &[0xFF; 2]))?;
    write("x_nested_merged", &wrong(&nested, b"MERG", 0, &[0xFF]))?;
    let wide = wrong(&nested, b"BOOK", 4, &(1_u32 << 24).to_le_bytes());
    write("x_nested_merged_width", &wrong(&wide, b"BOOK", 40 + 24, &(1_u32 << 24).to_le_bytes()))?;
    write("x_nested_size", &wrong(&nested, b"BOOK", 40 + 32, &[200]))?;
    write("x_factored_luma", &wrong(&factors, b"FACT", 0, &[0]))?;
    write("x_factored_stages", &wrong(&factors, b"FACT", 2, &[33]))?;
    write("x_factored_axes", &wrong(&factors, b"FACT", 4, &[200]))?;
    write("x_factored_count", &wrong(&factors, b"FACT", 8 + 2, &[6]))?;
    write("x_factored_step", &wrong(&factors, b"FACT", 8 + 4, &f32::NAN.to_le_bytes()))?;
    write("x_factored_index", &wrong(&factors, b"INDX", 1, &[4]))?;
    std::fs::write(folder.join("refused.csv"), refused)
}

/// Makes the CRCs right again, so that only what was changed is wrong.
fn reseal(mut file: Vec<u8>) -> Vec<u8> {
    let sections = usize::from(file[12]);
    for entry in (0..sections).map(|k| 24 + 24 * k) {
        let at = |offset: usize| usize::from(u16::from_le_bytes([file[offset], file[offset + 1]]));
        let (offset, length) = (at(entry + 8), at(entry + 16));
        let crc = crc32(&file[offset..(offset + length).min(file.len())]);
        file[entry + 4..entry + 8].copy_from_slice(&crc.to_le_bytes());
    }
    let end = 24 + 24 * sections;
    let crc = crc32(&file[..end]);
    file[end..end + 4].copy_from_slice(&crc.to_le_bytes());
    file
}

/// The file with another section behind all others, its CRC right.
fn with_section(file: &[u8], kind: &[u8; 4], bytes: &[u8]) -> Vec<u8> {
    let sections = usize::from(file[12]);
    let end = 24 + 24 * sections;
    let mut longer = file[..end].to_vec();
    longer[12] += 1;
    for entry in 0..sections {
        longer[24 + 24 * entry + 8] += 24;
    }
    longer.extend(kind);
    longer.extend([0; 4]);
    longer.extend((file.len() as u64 + 24).to_le_bytes());
    longer.extend((bytes.len() as u64).to_le_bytes());
    longer.extend(&file[end..]);
    longer.extend(bytes);
    let length = (longer.len() as u64).to_le_bytes();
    longer[16..24].copy_from_slice(&length);
    reseal(longer)
}

/// The file with another kind of its section number `entry`.
fn with_kind(file: &[u8], entry: usize, kind: &[u8; 4]) -> Vec<u8> {
    let mut file = file.to_vec();
    file[24 + 24 * entry..][..4].copy_from_slice(kind);
    reseal(file)
}

/// The example with four more bytes behind those of its header that are known.
fn longer_header(example: &[u8]) -> Vec<u8> {
    let mut file = example.to_vec();
    file.splice(156..156, [1, 2, 3, 4]);
    file[16] += 4;
    file[24 + 16] += 4;
    for entry in 1..4 {
        file[24 + 24 * entry + 8] += 4;
    }
    reseal(file)
}

/// The sections of a file in the other order.
fn other_order(file: &[u8]) -> Vec<u8> {
    let sections = usize::from(file[12]);
    let (mut table, mut body) = (Vec::new(), Vec::new());
    let start = 24 + 24 * sections + 4;
    for entry in (0..sections).rev().map(|k| &file[24 + 24 * k..][..24]) {
        let [offset, length] = [8, 16].map(|at| usize::from(u16::from_le_bytes([entry[at], entry[at + 1]])));
        table.extend(&entry[..8]);
        table.extend(((start + body.len()) as u64).to_le_bytes());
        table.extend(&entry[16..]);
        body.extend(&file[offset..offset + length]);
    }
    reseal([&file[..24], &table, &[0; 4], &body].concat())
}
