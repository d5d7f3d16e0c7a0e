//! Captures that are not what they should be: one clear line, exit code 2, and nothing left behind.

use std::path::Path;

use crate::common::{assert_refused, files, json, run, succeed};

/// A .npy file of version 1.0 with any header and any bytes.
fn write_npy(folder: &Path, name: &str, descr: &str, fortran: bool, shape: &str, values: &[u8]) {
    let fortran = if fortran { "True" } else { "False" };
    let mut header = format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}");
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).expect("a short header").to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(values);
    std::fs::write(folder.join(name), bytes).expect("a temporary folder");
}

/// Values of a 2 × 2 capture with windows of 3 × 3 pixels.
fn values() -> Vec<u8> {
    let rd = |k: usize| 0.1 / (1.0 + (k % 7) as f32);
    (0..2 * 2 * 3 * 3 * 3).flat_map(|k| rd(k).to_le_bytes()).collect()
}

const SHAPE: &str = "(2, 2, 3, 3, 3)";

#[test]
fn wrong_arrays_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let expected = "(H, W, D, D, 3)";
    for (name, descr, fortran, shape, values, words) in [
        ("double", "<f8", false, SHAPE, values(), ["cut: 432 bytes", "864 bytes"]),
        ("complex", "<c8", true, SHAPE, values(), ["type '<c8'", expected]),
        ("big_endian", ">i4", false, SHAPE, values(), ["type '>i4'", expected]),
        ("integer", "<i4", false, SHAPE, values(), ["type '<i4'", expected]),
        ("flat", "<f4", false, "(108,)", values(), ["shape [108]", expected]),
        ("four_channels", "<f4", false, "(2, 2, 3, 3, 4)", values(), ["shape [2, 2, 3, 3, 4]", expected]),
        ("oblong", "<f4", false, "(2, 2, 3, 1, 3)", values(), ["not square", expected]),
        ("even", "<f4", false, "(2, 2, 4, 4, 3)", values(), ["window of 4 pixels", "odd window"]),
        ("empty", "<f4", false, "(0, 2, 3, 3, 3)", vec![], ["height 0", "1 to 65535"]),
        ("cut", "<f4", false, SHAPE, values()[..400].to_vec(), ["cut: 400 bytes", "432 bytes"]),
        ("huge", "<f4", false, "(65535, 65535, 3, 3, 3)", values(), ["cut", "bytes for shape"]),
        ("overflow", "<f4", false, "(99999999999, 99999999999, 3, 3, 3)", vec![], ["shape 99999999999", expected]),
        (
            "nested",
            "<f4",
            false,
            "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]",
            vec![],
            ["nested", expected],
        ),
        ("no_numbers", "<f4", false, SHAPE, vec![0; 432], ["nothing measured", "at least one"]),
    ] {
        write_npy(folder, &format!("{name}.npy"), descr, fortran, shape, &values);
        std::fs::write(folder.join(format!("{name}.json")), r#"{"pitch_mm": 0.5}"#).unwrap();
        let refused = run(folder, &format!("encode {name}.npy"));
        assert_refused(&refused, &[&format!("{name}.npy"), words[0], words[1]]);
        assert!(!folder.join(format!("{name}.subsurf")).exists(), "{name}: nothing is written");
    }
    std::fs::write(folder.join("text.npy"), "not an array").unwrap();
    assert_refused(&run(folder, "encode text.npy --pitch 1"), &["text.npy", expected]);
    assert_refused(&run(folder, "encode missing.npy --pitch 1"), &["missing.npy", "No such file"]);
    assert_refused(&run(folder, "encode . --pitch 1"), &["a capture (.npy)"]);
    // Whatever name they are given, inputs are not written over.
    write_npy(folder, "sound.npy", "<f4", false, SHAPE, &values());
    assert_refused(&run(folder, "encode sound.npy --pitch 1 -o ./sound.npy"), &["would overwrite", "sound.npy"]);
    assert_refused(&run(folder, "encode sound.npy --pitch 1 -o nowhere/a.subsurf"), &["no folder nowhere"]);
    assert_refused(&run(folder, "encode sound.npy --pitch 1 -S 1"), &["1 samples", "2 to 4096"]);
    assert!(!files(folder).iter().any(|name| name.starts_with('.')), "no temporary files: {:?}", files(folder));
}

#[test]
fn the_pitch_has_to_come_from_somewhere() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_npy(folder, "a.npy", "<f4", false, SHAPE, &values());
    assert_refused(&run(folder, "encode a.npy"), &["a.npy", "no pixel pitch", "--pitch", "\"pitch_mm\""]);
    succeed(folder, "encode a.npy --pitch 0.25 -M 2");
    assert_eq!(json(folder, "info a.subsurf --json")["pitch_mm"], 0.25);

    std::fs::write(folder.join("a.json"), r#"{"pitch_mm": 0.75, "addressing": "mirror", "eta": 1.25, "camera": 7}"#)
        .unwrap();
    succeed(folder, "encode a.npy -M 2");
    let info = json(folder, "info a.subsurf --json");
    assert_eq!((&info["pitch_mm"], &info["addressing"], &info["eta"]), (&0.75.into(), &"mirror".into(), &1.25.into()));
    succeed(folder, "encode a.npy -M 2 --pitch 2 --addressing repeat --eta 1.5");
    let info = json(folder, "info a.subsurf --json");
    assert_eq!((&info["pitch_mm"], &info["addressing"], &info["eta"]), (&2.0.into(), &"repeat".into(), &1.5.into()));

    for (sidecar, words) in [
        ("{", ["unreadable sidecar", "pitch_mm"]),
        ("[1]", ["unreadable sidecar", "pitch_mm"]),
        (r#"{"pitch_mm": "wide"}"#, ["unreadable sidecar", "pitch_mm"]),
        (r#"{"pitch": 0.5}"#, ["no pixel pitch", "pitch_mm"]),
        (r#"{"pitch_mm": 0}"#, ["pixel pitch 0 mm", "a length from"]),
        (r#"{"pitch_mm": -1}"#, ["pixel pitch -1 mm", "a length from"]),
        (r#"{"pitch_mm": 0.5, "addressing": "wrap"}"#, ["unreadable sidecar", "clamp, repeat, mirror"]),
        (r#"{"pitch_mm": 0.5, "eta": 0.5}"#, ["refractive index 0.5", "1 to 4"]),
    ] {
        std::fs::write(folder.join("a.json"), sidecar).unwrap();
        assert_refused(&run(folder, "encode a.npy -o b.subsurf"), &words);
    }
    assert!(!folder.join("b.subsurf").exists(), "nothing is written");
}

#[test]
fn half_floats_are_captures_too() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (name, half) in [("full", ""), ("half", "--half")] {
        succeed(folder, &format!("simulate --material jade --size 8 --window 5 --thickness 5 {half} -o {name}.npy"));
        succeed(folder, &format!("encode {name}.npy -M 8"));
    }
    let bytes = |name: &str| std::fs::metadata(folder.join(name)).unwrap().len();
    assert_eq!(bytes("full.npy") - bytes("half.npy"), 2 * 8 * 8 * 25 * 3, "two bytes of each value saved");
    // Judged by the full one, the half one loses little.
    let error = |file: &str| {
        let judgement = json(folder, &format!("compare full.npy {file} --json"));
        judgement["relative_error_mean"].as_f64().unwrap()
    };
    assert!(error("half.subsurf") < error("full.subsurf") + 1e-3, "{}", error("half.subsurf"));
}
