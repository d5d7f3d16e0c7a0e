//! Arrays as NumPy and other programs write them: every order and type is the same capture.

use std::io::{Cursor, Write};
use std::path::Path;

use half::f16;
use subsurf_encoder::bssrdf::{Options, encode};
use subsurf_encoder::capture::{Capture, Overrides};
use subsurf_tests::mutate::assert_survives;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use crate::warnings::Warnings;

/// Height, width, window, window, channels.
const SHAPE: [usize; 5] = [2, 3, 3, 3, 3];
const VALUES: usize = 2 * 3 * 3 * 3 * 3;

/// Values that half floats hold exactly, in C order.
fn values() -> Vec<f32> {
    (0..VALUES).map(|k| (1 + k % 97) as f32 / 256.0).collect()
}

/// Values in the order of Fortran: the first index runs fastest.
fn fortran(values: &[f32]) -> Vec<f32> {
    let mut out = Vec::new();
    for at in 0..VALUES {
        let mut rest = at;
        let mut index = [0; 5];
        for axis in 0..5 {
            index[axis] = rest % SHAPE[axis];
            rest /= SHAPE[axis];
        }
        let c_order = index.iter().zip(SHAPE).fold(0, |sum, (index, side)| sum * side + index);
        out.push(values[c_order]);
    }
    out
}

/// A `.npy` file of any version.
fn npy(version: u8, descr: &str, is_fortran: bool, values: &[u8]) -> Vec<u8> {
    let is_fortran = if is_fortran { "True" } else { "False" };
    let shape = SHAPE.map(|side| side.to_string()).join(", ");
    let header = format!("{{'descr': '{descr}', 'fortran_order': {is_fortran}, 'shape': ({shape}), }}\n");
    let length = u32::try_from(header.len()).unwrap().to_le_bytes();
    let length = if version == 1 { &length[..2] } else { &length[..] };
    [b"\x93NUMPY", &[version, 0][..], length, header.as_bytes(), values].concat()
}

fn bytes<const N: usize>(values: &[f32], convert: impl Fn(f32) -> [u8; N]) -> Vec<u8> {
    values.iter().flat_map(|value| convert(*value)).collect()
}

fn npz(entries: &[(&str, &[u8])], method: CompressionMethod) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        let options = SimpleFileOptions::default().compression_method(method).large_file(true);
        archive.start_file(*name, options).unwrap();
        archive.write_all(bytes).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

fn open(path: &Path) -> Result<Capture, subsurf_encoder::Error> {
    Capture::open(path, &Overrides { pitch_mm: Some(0.5), ..Overrides::default() })
}

/// All windows of a capture, and how many values are too small.
fn windows(capture: &Capture) -> (Vec<f32>, u64) {
    let mut all = Vec::new();
    let mut faint = 0;
    for pixel in 0..capture.pixels() {
        let mut window = vec![0.0; capture.window_len()];
        faint += capture.read_window(pixel, &mut window);
        all.extend(window);
    }
    (all, faint)
}

#[test]
fn every_order_and_type_is_the_same_capture() {
    let folder = tempfile::tempdir().unwrap();
    let values = values();
    let turned = fortran(&values);
    let single = npy(1, "<f4", false, &bytes(&values, f32::to_le_bytes));
    let scalar = b"\x93NUMPY\x01\x00\x38\x00{'descr': '<f8', 'fortran_order': False, 'shape': (), }\n\0\0\0\0\0\0\xe0?"
        .as_slice();
    let stored = CompressionMethod::Stored;
    for (name, file) in [
        ("plain.npy", single.clone()),
        ("version2.npy", npy(2, "<f4", false, &bytes(&values, f32::to_le_bytes))),
        ("version3.npy", npy(3, "<f4", false, &bytes(&values, f32::to_le_bytes))),
        ("fortran.npy", npy(1, "<f4", true, &bytes(&turned, f32::to_le_bytes))),
        ("big.npy", npy(1, ">f4", false, &bytes(&values, f32::to_be_bytes))),
        ("double.npy", npy(1, "<f8", false, &bytes(&values, |value| f64::from(value).to_le_bytes()))),
        ("big_double.npy", npy(1, ">f8", true, &bytes(&turned, |value| f64::from(value).to_be_bytes()))),
        ("half.npy", npy(1, "<f2", false, &bytes(&values, |value| f16::from_f32(value).to_le_bytes()))),
        ("big_half.npy", npy(1, ">f2", true, &bytes(&turned, |value| f16::from_f32(value).to_be_bytes()))),
        ("one.npz", npz(&[("arr_0.npy", &single)], stored)),
        ("deflated.npz", npz(&[("rd.npy", &single)], CompressionMethod::Deflated)),
        ("several.npz", npz(&[("pitch.npy", scalar), ("notes.txt", b"notes"), ("rd.npy", &single)], stored)),
        ("archive.npy", npz(&[("pitch.npy", scalar), ("rd.npy", &single)], CompressionMethod::Deflated)),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, file).unwrap();
        let capture = open(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((capture.height(), capture.width(), capture.radius()), (2, 3, 1), "{name}");
        assert_eq!(windows(&capture), (values.clone(), 0), "{name}");
        let others = if ["several.npz", "archive.npy"].contains(&name) { 1 } else { 0 };
        assert_eq!(capture.warnings().len(), others, "{name}: {:?}", capture.warnings());
    }
}

#[test]
fn what_cannot_be_read_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let single = npy(1, "<f4", false, &bytes(&values(), f32::to_le_bytes));
    let stored = CompressionMethod::Stored;
    let mut cut = npz(&[("rd.npy", &single)], stored);
    cut.truncate(cut.len() - 30);
    for (name, file, words) in [
        ("complex.npy", npy(1, "<c8", false, &[]), "type '<c8'"),
        ("integers.npy", npy(1, ">i4", false, &[]), "type '>i4'"),
        ("objects.npy", npy(1, "|O", false, &[]), "type '|O'"),
        ("no_array.npz", npz(&[("notes.txt", b"notes")], stored), "without an array"),
        ("two.npz", npz(&[("a.npy", &single), ("b.npy", &single)], stored), "arrays a, b, several of them"),
        ("none.npz", npz(&[("a.npy", b"a"), ("b.npy", b"b")], stored), "arrays a, b, none of them"),
        ("cut.npz", cut, "a broken .npz file"),
        ("empty.npy", Vec::new(), "not a readable .npy header"),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, file).unwrap();
        let error = open(&path).err().unwrap_or_else(|| panic!("{name} is read")).to_string();
        assert!(error.contains(name) && error.contains(words) && error.contains("expected"), "{error}");
        assert_eq!(error.lines().count(), 1, "{error}");
    }
}

#[test]
fn what_is_too_small_was_not_measured_and_is_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npy");
    let mut values = values();
    (values[3], values[40], values[41], values[42]) = (1e-41, 1e-41, f32::NAN, -1.0);
    let mut kept = values.clone();
    [3, 40, 41, 42].iter().for_each(|&k| kept[k] = 0.0);
    std::fs::write(&path, npy(1, "<f4", false, &bytes(&values, f32::to_le_bytes))).unwrap();
    assert_eq!(windows(&open(&path).unwrap()), (kept.clone(), 2));
    let tiny = |value: f32| if value == 1e-41 { 1e-300 } else { f64::from(value) }.to_le_bytes();
    std::fs::write(&path, npy(1, "<f8", false, &bytes(&values, tiny))).unwrap();
    assert_eq!(windows(&open(&path).unwrap()), (kept, 2));

    let warnings = Warnings::default();
    let options = Options { base_materials: 2, ..Options::default() };
    encode(&open(&path).unwrap(), None, &options, &warnings).unwrap();
    let warnings = warnings.into_lines();
    assert!(matches!(&warnings[..], [one] if one.contains("a.npy: 2 values")), "{warnings:?}");

    std::fs::write(&path, npy(1, "<f4", false, &bytes(&[1e-41; VALUES], f32::to_le_bytes))).unwrap();
    let error = encode(&open(&path).unwrap(), None, &options, &()).unwrap_err().to_string();
    assert!(error.contains("nothing measured") && error.contains("162 are below"), "{error}");

    // Half floats have no such values: their smallest ones are a measurement.
    std::fs::write(&path, npy(1, "<f2", false, &[1_u8, 0].repeat(VALUES))).unwrap();
    assert_eq!(windows(&open(&path).unwrap()), (vec![f16::from_bits(1).to_f32(); VALUES], 0));

    let longer = [npy(1, "<f2", false, &[1_u8, 0].repeat(VALUES)), vec![0; 7]].concat();
    std::fs::write(&path, longer).unwrap();
    let capture = open(&path).unwrap();
    assert!(
        matches!(capture.warnings(), [one] if one.contains("7 bytes behind the array")),
        "{:?}",
        capture.warnings()
    );
}

#[test]
fn no_mutation_of_an_array_panics() {
    let values = values();
    let single = npy(1, "<f4", false, &bytes(&values, f32::to_le_bytes));
    let double = npy(2, ">f8", true, &bytes(&fortran(&values), |value| f64::from(value).to_be_bytes()));
    let archives = [
        npz(&[("rd.npy", &single)], CompressionMethod::Stored),
        npz(&[("a.npy", b"a"), ("rd.npy", &double)], CompressionMethod::Deflated),
    ];
    let read = |path: &Path| open(path).map(|capture| windows(&capture));
    println!("npy: {:?}", assert_survives("a.npy", &[single, double], read));
    println!("npz: {:?}", assert_survives("a.npz", &archives, read));
}
