//! The files of `vectors/` read as `results.txt` says, and as whatever breaks them should.

use std::collections::BTreeMap;
use std::path::Path;

use subsurf_decoder::container::Crc;
use subsurf_decoder::{Bssrdf, ReadError};
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
        assert_eq!(found == "refused", name.starts_with('x'), "{name}: {:?}", Bssrdf::parse(&bytes).err());
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
}

#[test]
fn the_example_of_the_specification_is_the_file() {
    let file = std::fs::read(folder().join("format_example.subsurf")).unwrap();
    assert_eq!(file, format_example());
    assert_eq!(file.len(), 216);
}

/// Every file cut at every length, and with every byte changed: an error or bounded values.
#[test]
fn damage_is_refused_or_harmless() {
    for name in ["bmpp_mirror.subsurf", "per_pixel_clamp.subsurf", "one_pixel.subsurf"] {
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
            }
        }
    }
}
