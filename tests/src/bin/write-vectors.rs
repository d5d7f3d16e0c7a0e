//! Writes `tests/vectors/` anew: small files of every kind, broken ones, and what reading them must give.

use std::fmt::Write as _;
use std::path::Path;

use subsurf_decoder::bssrdf::{Addressing, Coding};
use subsurf_decoder::container::crc32;
use subsurf_encoder::bssrdf::basis::{FittedBasis, with_basis};
use subsurf_encoder::synthetic::Shape;
use subsurf_tests::kernels::{difference, format_kernel, skin};
use subsurf_tests::transfer::format_transfer;
use subsurf_tests::{fingerprint, format_basis, format_example, shape};

fn main() -> std::io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("vectors");
    let mut results = String::new();
    let mut write = |name: &str, bytes: &[u8]| -> std::io::Result<()> {
        std::fs::write(folder.join(name), bytes)?;
        let found = fingerprint(bytes).map_or("refused".to_owned(), |crc| format!("{crc:08x}"));
        // Writing to a string cannot fail.
        let _ = writeln!(results, "{name}: {found}");
        Ok(())
    };

    let example = format_example();
    write("format_example.subsurf", &example)?;
    let odd = |addressing| shape([7, 5], 3, addressing);
    write("bmpp_clamp.subsurf", &odd(Addressing::Clamp).bmpp())?;
    write("bmpp_repeat.subsurf", &odd(Addressing::Repeat).bmpp())?;
    write("bmpp_mirror.subsurf", &odd(Addressing::Mirror).bmpp())?;
    write("per_pixel_clamp.subsurf", &odd(Addressing::Clamp).per_pixel())?;
    let clamp = odd(Addressing::Clamp);
    write("one_base.subsurf", &clamp.k_bmpp(1, Coding::Exact, false))?;
    write("one_of_300_bases.subsurf", &Shape { base_materials: 300, ..clamp }.k_bmpp(1, Coding::Exact, false))?;
    write("three_bases.subsurf", &clamp.k_bmpp(3, Coding::Exact, false))?;
    write("five_bases.subsurf", &clamp.k_bmpp(5, Coding::Exact, false))?;
    write("small_ratios.subsurf", &clamp.k_bmpp(2, Coding::SmallRatios, false))?;
    write("palette.subsurf", &clamp.k_bmpp(2, Coding::Palette, false))?;
    write("half_profiles.subsurf", &clamp.k_bmpp(2, Coding::Exact, true))?;
    let one = Shape { size: [1, 1], radius: 0, samples: 2, base_materials: 1, addressing: Addressing::Clamp };
    write("one_pixel.subsurf", &one.bmpp())?;
    let full = Shape { base_materials: 255, ..shape([16, 16], 2, Addressing::Repeat) };
    write("many_bases.subsurf", &full.bmpp())?;
    let based = with_basis(&example, &format_basis()).expect("a basis in range");
    write("separable_basis.subsurf", &based)?;

    let kernel = format_kernel().to_bytes().expect("a kernel in range");
    write("kernel_example.subsurf", &kernel)?;
    write("kernel_two_gaussians.subsurf", &skin(17).to_bytes().expect("a kernel in range"))?;
    write("kernel_two_terms.subsurf", &difference(11).to_bytes().expect("a kernel in range"))?;

    let transfer = format_transfer();
    write("transfer_example.subsurf", &transfer)?;

    // Broken, each in one way.
    let broken = |at: usize, value: u8| {
        let mut bytes = example.clone();
        bytes[at] = value;
        bytes
    };
    write("x_magic.subsurf", &broken(1, b'X'))?;
    write("x_newer_major.subsurf", &reseal(broken(8, 2)))?;
    write("x_header_crc.subsurf", &broken(120, example[120] ^ 1))?;
    write("x_profile_crc.subsurf", &broken(156, example[156] ^ 1))?;
    write("x_cut.subsurf", &example[..example.len() - 1])?;
    write("x_model.subsurf", &reseal(broken(124, 9)))?;
    write("x_index.subsurf", &reseal(broken(213, 2)))?;
    write("x_ratio.subsurf", &reseal(broken(207, 0x40)))?;
    write("x_profile_infinite.subsurf", &reseal(broken(159, 0xFF)))?;
    write("x_overlap.subsurf", &reseal(broken(24 + 24 + 8, 150)))?;
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
    write("x_basis_width.subsurf", &wrong(&|basis| basis.sigmas[0] = 0.0))?;
    write("x_basis_widths_fall.subsurf", &wrong(&|basis| basis.sigmas[1] = 0.25))?;
    write("x_basis_nan.subsurf", &wrong(&|basis| basis.weights[3][1] = f32::NAN))?;
    write("x_basis_huge.subsurf", &wrong(&|basis| basis.projection[2][0] = 2e15))?;
    write("x_basis_terms.subsurf", &wrong(&|basis| basis.size.terms = 3))?;
    let wrong = |at: usize, value: &[u8]| {
        let mut bytes = kernel.clone();
        bytes[at..at + value.len()].copy_from_slice(value);
        reseal(bytes)
    };
    write("x_kernel_method.subsurf", &wrong(124, &[6]))?;
    write("x_kernel_taps_even.subsurf", &wrong(127, &[4]))?;
    write("x_kernel_signs.subsurf", &wrong(132, &[8]))?;
    write("x_kernel_offset_first.subsurf", &wrong(148, &0.25_f32.to_le_bytes()))?;
    write("x_kernel_offsets_fall.subsurf", &wrong(156, &0.5_f32.to_le_bytes()))?;
    write("x_kernel_offset_radius.subsurf", &wrong(156, &2.0_f32.to_le_bytes()))?;
    write("x_kernel_weight_nan.subsurf", &wrong(172, &f32::NAN.to_le_bytes()))?;
    write("x_kernel_energy.subsurf", &wrong(172, &0.25_f32.to_le_bytes()))?;
    write("x_kernel_tail_rises.subsurf", &wrong(208, &0.8_f32.to_le_bytes()))?;
    write("x_kernel_tail_end.subsurf", &wrong(220, &0.125_f32.to_le_bytes()))?;
    let wrong = |at: usize, value: &[u8]| {
        let mut bytes = transfer.clone();
        bytes[at..at + value.len()].copy_from_slice(value);
        reseal(bytes)
    };
    write("x_transfer_channels.subsurf", &wrong(197, &[2]))?;
    write("x_transfer_bits.subsurf", &wrong(239, &[1]))?;
    write("x_transfer_record.subsurf", &wrong(236, &[12; 16]))?;
    write("x_transfer_light.subsurf", &wrong(252, &0.5_f32.to_le_bytes()))?;
    write("x_transfer_step.subsurf", &wrong(304, &(-0.5_f32).to_le_bytes()))?;
    write("x_transfer_cluster.subsurf", &wrong(382, &[2]))?;
    write("x_transfer_tail.subsurf", &wrong(388, &1.5_f32.to_le_bytes()))?;
    std::fs::write(folder.join("results.txt"), results)
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
