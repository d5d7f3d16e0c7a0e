//! The files of `vectors/` read as `results.txt` says, and as whatever breaks them should.

use std::collections::BTreeMap;
use std::path::Path;

use subsurf_decoder::container::Crc;
use subsurf_decoder::{Bssrdf, File, Kernel, ReadError, Section, Transfer};
use subsurf_tests::kernels::format_kernel;
use subsurf_tests::transfer::format_transfer;
use subsurf_tests::{fingerprint, format_example};

fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/vectors"))
}

#[test]
fn every_file_reads_as_recorded() {
    let text = std::fs::read_to_string(folder().join("results.txt")).unwrap();
    let recorded: BTreeMap<&str, &str> = text.lines().map(|line| line.split_once(": ").unwrap()).collect();
    let mut seen = 0;
    for entry in std::fs::read_dir(folder()).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if name == "results.txt" {
            continue;
        }
        let bytes = std::fs::read(folder().join(&name)).unwrap();
        let found = fingerprint(&bytes).map_or("refused".to_owned(), |crc| format!("{crc:08x}"));
        assert_eq!(recorded.get(&name[..]).copied(), Some(&found[..]), "{name}");
        assert_eq!(found == "refused", name.starts_with('x'), "{name}: {:?}", File::parse(&bytes).err());
        seen += 1;
    }
    assert_eq!(seen, recorded.len(), "all of results.txt is there");
}

#[test]
fn broken_files_are_refused_for_what_is_broken() {
    let error = |name: &str| {
        let bytes = std::fs::read(folder().join(name)).unwrap();
        Bssrdf::parse(&bytes).unwrap_err()
    };
    assert!(matches!(error("x_magic.subsurf"), ReadError::NotSubsurf), "magic");
    assert!(matches!(error("x_newer_major.subsurf"), ReadError::NewerVersion { major: 2, .. }), "version");
    assert!(matches!(error("x_header_crc.subsurf"), ReadError::Checksum { .. }), "header CRC");
    assert!(matches!(error("x_profile_crc.subsurf"), ReadError::Checksum { .. }), "profile CRC");
    assert!(matches!(error("x_cut.subsurf"), ReadError::Truncated { .. }), "cut");
    assert!(matches!(error("x_model.subsurf"), ReadError::BadField { value: 9, .. }), "model");
    assert!(matches!(error("x_index.subsurf"), ReadError::IndexOutOfRange { index: 2, len: 2, .. }), "index");
    assert!(matches!(error("x_ratio.subsurf"), ReadError::BadNumber { .. }), "ratio");
    assert!(matches!(error("x_profile_infinite.subsurf"), ReadError::BadNumber { .. }), "profile");
    assert!(matches!(error("x_overlap.subsurf"), ReadError::Overlap { .. }), "overlap");
    for name in ["x_basis_width", "x_basis_widths_fall", "x_basis_nan", "x_basis_huge"] {
        let found = error(&format!("{name}.subsurf"));
        assert!(matches!(found, ReadError::BadNumber { section: Section::SeparableBasis, .. }), "{name}: {found}");
    }
    assert!(matches!(error("x_basis_terms.subsurf"), ReadError::BadField { value: 3, .. }), "terms");
}

#[test]
fn broken_kernels_are_refused_for_what_is_broken() {
    let error = |name: &str| {
        let bytes = std::fs::read(folder().join(format!("x_kernel_{name}.subsurf"))).unwrap();
        Kernel::parse(&bytes).unwrap_err()
    };
    for (name, value) in [("method", 6), ("taps_even", 4), ("signs", 8)] {
        assert!(matches!(error(name), ReadError::BadField { value: found, .. } if found == value), "{name}");
    }
    let numbers = [
        ("offset_first", Section::KernelOffsets),
        ("offsets_fall", Section::KernelOffsets),
        ("offset_radius", Section::KernelOffsets),
        ("weight_nan", Section::KernelWeights),
        ("energy", Section::KernelWeights),
        ("tail_rises", Section::KernelTail),
        ("tail_end", Section::KernelTail),
    ];
    for (name, expected) in numbers {
        let found = error(name);
        assert!(matches!(found, ReadError::BadNumber { section, .. } if section == expected), "{name}: {found}");
    }
}

#[test]
fn broken_transfers_are_refused_for_what_is_broken() {
    let error = |name: &str| {
        let bytes = std::fs::read(folder().join(format!("x_transfer_{name}.subsurf"))).unwrap();
        Transfer::parse(&bytes).unwrap_err()
    };
    for (name, value) in [("channels", 2), ("bits", 1), ("record", 12)] {
        assert!(matches!(error(name), ReadError::BadField { value: found, .. } if found == value), "{name}");
    }
    let numbers = [("light", Section::Lights), ("step", Section::ClusterRanges), ("tail", Section::KernelTail)];
    for (name, expected) in numbers {
        let found = error(name);
        assert!(matches!(found, ReadError::BadNumber { section, .. } if section == expected), "{name}: {found}");
    }
    assert!(matches!(error("cluster"), ReadError::IndexOutOfRange { index: 2, len: 2, .. }), "cluster");
}

#[test]
fn the_transfer_of_the_specification_is_the_file() {
    let file = std::fs::read(folder().join("transfer_example.subsurf")).unwrap();
    assert_eq!(file, format_transfer());
    assert_eq!(file.len(), 412);
}

#[test]
fn the_kernel_of_the_specification_is_the_file() {
    let file = std::fs::read(folder().join("kernel_example.subsurf")).unwrap();
    assert_eq!(file, format_kernel().to_bytes().unwrap());
    assert_eq!(file.len(), 232);
}

#[test]
fn the_example_of_the_specification_is_the_file() {
    let file = std::fs::read(folder().join("format_example.subsurf")).unwrap();
    assert_eq!(file, format_example());
    assert_eq!(file.len(), 216);
}

/// Coefficients worked out by hand from FORMAT.md, section 2.7: P̂ of pixel 0 is (−1, −2, −3), (−2, −4, −6).
#[test]
fn a_basis_says_what_the_specification_says() {
    let file = std::fs::read(folder().join("separable_basis.subsurf")).unwrap();
    assert_eq!(file.len(), 216 + 24 + 4 + 4 * 2 + 6 * 2 * 6 + 12 * 2 * 2);
    let material = Bssrdf::parse(&file).unwrap();
    let basis = material.basis().unwrap();
    let of_pixel = |l| basis.coefficient(l, &material.profile([0, 0]));
    let close = |found: [f32; 3], expected: [f64; 3]| {
        (0..3).all(|c| (f64::from(found[c]) - expected[c]).abs() < 1e-5 * expected[c].abs().max(1.0))
    };
    let e = |p: f64| (0.5 * p).exp();
    assert!(close(of_pixel(0), [e(-1.0) + 0.5 * e(-2.0), 2.0 * e(-2.0), 3.0 * e(-3.0) - 0.5 * e(-6.0)]), "c_0");
    assert!(close(of_pixel(1), [-e(-1.0) + 2.0 * e(-2.0), e(-2.0) + 4.0 * e(-4.0), 8.0 * e(-6.0)]), "c_1");
    assert_eq!(basis.weight(0, 1, 1), [0.0, 0.5, -0.5]);
    assert_eq!(basis.weight(1, 0, 1), basis.weight(0, 1, 1), "symmetric");
    // V_0 = Σ k² e^(−2 k²) / Σ e^(−2 k²) = 0.2150; s = max(1, ⌊1.8 √0.2150⌋) = 1, t = ⌈3.2 √(4 − 0.2150)⌉ = 7.
    let cascade = basis.cascade();
    let taps: Vec<_> = cascade.stages().iter().map(|stage| (stage.stride, stage.taps)).collect();
    assert_eq!(taps, [(1, 2), (1, 7)]);
}

/// Every file cut at every length, and with every byte changed: an error or bounded values.
#[test]
fn damage_is_refused_or_harmless() {
    for name in ["bmpp_mirror.subsurf", "per_pixel_clamp.subsurf", "one_pixel.subsurf", "separable_basis.subsurf"] {
        let file = std::fs::read(folder().join(name)).unwrap();
        for length in 0..file.len() {
            assert!(Bssrdf::parse(&file[..length]).is_err(), "{name} cut to {length} bytes");
        }
        for at in 0..file.len() {
            let mut damaged = file.clone();
            damaged[at] ^= 0xFF;
            assert!(Bssrdf::parse(&damaged).is_err(), "{name}: a CRC covers byte {at}");
            if let Ok(material) = Bssrdf::parse_with(&damaged, Crc::Skip) {
                let rd = material.rd([1, -2], [2, 1]);
                assert!(rd.iter().all(|rd| rd.is_finite() && *rd >= 0.0), "{name}, byte {at}: {rd:?}");
                if let Some(basis) = material.basis() {
                    let c = basis.coefficient(0, &material.profile([1, -2]));
                    assert!(c.iter().all(|c| c.is_finite()), "{name}, byte {at}: {c:?}");
                    assert!(basis.cascade().stages().iter().all(|stage| stage.taps < 64), "{name}, byte {at}");
                }
            }
        }
    }
}
