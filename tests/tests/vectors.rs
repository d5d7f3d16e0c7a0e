//! The files of `vectors/` hold what the tables beside them say, and broken ones are refused for what `refused.csv` says.

use std::collections::BTreeMap;
use std::path::Path;

use subsurf_decoder::container::Crc;
use subsurf_decoder::{Bssrdf, File};
use subsurf_tests::format_example;
use subsurf_tests::kernels::format_kernel;
use subsurf_tests::transfer::format_transfer;
use subsurf_tests::vectors::{HEADER, Line, answer, table};

fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/vectors"))
}

/// Names and contents of all files.
fn files() -> BTreeMap<String, Vec<u8>> {
    let paths = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
    let files = paths.filter(|path| path.extension().is_some_and(|extension| extension == "subsurf"));
    files.map(|path| (path.file_stem().unwrap().to_str().unwrap().to_owned(), std::fs::read(path).unwrap())).collect()
}

#[test]
fn good_files_hold_what_their_tables_say() {
    let good: Vec<_> = files().into_iter().filter(|(name, _)| !name.starts_with('x')).collect();
    // And the one of refused files.
    let tables = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
    let tables = tables.filter(|path| path.extension().is_some_and(|extension| extension == "csv")).count();
    assert_eq!(tables, good.len() + 1, "a table for each file, and a file for each table");
    for (name, bytes) in good {
        let content = File::parse(&bytes).unwrap_or_else(|error| panic!("{name}: {error}")).content();
        let text = std::fs::read_to_string(folder().join(format!("{name}.csv"))).unwrap();
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some(HEADER), "{name}");
        let lines: Vec<Line> = lines.map(Line::read).collect();
        assert!(lines.len() > 1, "{name}: a table");
        for Line { query, values, tolerance } in &lines {
            let found = answer(&content, query);
            let is_close = |(found, value): (&f32, &f32)| (found - value).abs() <= *tolerance;
            assert_eq!(found.len(), values.len(), "{name}: {query:?}");
            assert!(found.iter().zip(values).all(is_close), "{name}: {query:?}: {found:?}, not {values:?}");
        }
        let asked = |table: &str| table.lines().skip(1).map(|line| Line::read(line).query).collect::<Vec<_>>();
        assert_eq!(asked(&text), asked(&table(&bytes).unwrap()), "{name}: written by write-vectors as it is now");
    }
}

#[test]
fn broken_files_are_refused_for_what_is_broken() {
    let text = std::fs::read_to_string(folder().join("refused.csv")).unwrap();
    let due: BTreeMap<&str, &str> = text.lines().skip(1).map(|line| line.split_once(',').unwrap()).collect();
    let files = files();
    let broken: Vec<_> = files.iter().filter(|(name, _)| name.starts_with('x')).collect();
    for (name, bytes) in &broken {
        let name = format!("{name}.subsurf");
        let error = File::parse(bytes).err().unwrap_or_else(|| panic!("{name}: not refused")).to_string();
        assert_eq!(due.get(&name[..]).copied(), Some(&format!("\"{error}\"")[..]), "{name}");
    }
    assert_eq!(broken.len(), due.len(), "all of refused.csv are there");
}

#[test]
fn the_transfer_of_the_specification_is_the_file() {
    let file = std::fs::read(folder().join("transfer_example.subsurf")).unwrap();
    assert_eq!(file, format_transfer());
    assert_eq!(file.len(), 432);
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
