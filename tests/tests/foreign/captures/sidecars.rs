//! Sidecars of captures as editors and other programs leave them.

use std::path::Path;

use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::capture::{Capture, CaptureWriter, Overrides, Scalar, check_capture_target, sidecar_path};
use subsurf_tests::mutate::assert_survives;
use subsurf_tests::write_capture;

fn capture(folder: &Path) -> std::path::PathBuf {
    write_capture(folder, "a.npy", [2, 2], 1, Addressing::Clamp, |_, _, _| 0.1)
}

fn utf16(text: &str, unit: fn(u16) -> [u8; 2]) -> Vec<u8> {
    std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(unit).collect()
}

#[test]
fn marks_of_encodings_are_no_content() {
    let folder = tempfile::tempdir().unwrap();
    let path = capture(folder.path());
    let text = "{\"pitch_mm\": 0.75,\r\n \"addressing\": \"mirror\"}";
    for (name, bytes) in [
        ("plain", text.as_bytes().to_vec()),
        ("UTF-8 with a mark", [b"\xef\xbb\xbf", text.as_bytes()].concat()),
        ("UTF-16, little-endian", utf16(text, u16::to_le_bytes)),
        ("UTF-16, big-endian", utf16(text, u16::to_be_bytes)),
    ] {
        std::fs::write(sidecar_path(&path), bytes).unwrap();
        let capture = Capture::open(&path, &Overrides::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!((capture.pitch_mm(), capture.addressing()), (0.75, Addressing::Mirror), "{name}");
        assert!(capture.warnings().is_empty(), "{name}: {:?}", capture.warnings());
    }
}

#[test]
fn keys_that_are_not_known_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = capture(folder.path());
    let open = |sidecar: &str| {
        std::fs::write(sidecar_path(&path), sidecar).unwrap();
        Capture::open(&path, &Overrides::default())
    };
    let warnings = |sidecar| open(sidecar).unwrap().warnings().to_vec();
    let named = warnings(r#"{"pitch_mm": 0.5, "camera": {"name": [1]}, "Eta": 1.3}"#);
    assert!(
        matches!(&named[..], [one] if one.contains(r#"unknown keys are left out (2): "Eta", "camera""#)),
        "{named:?}"
    );
    let named = warnings(r#"{"pitch_mm": 0.5, "line\nbreak": null}"#);
    assert!(matches!(&named[..], [one] if one.contains(r#""line\nbreak""#) && one.lines().count() == 1), "{named:?}");
    assert!(warnings(r#"{"pitch_mm": 0.5, "eta": 1.5, "addressing": "clamp", "simulated": {}}"#).is_empty());
    for (sidecar, words) in [
        (r#"{"pitch": 0.5}"#, r#"no pixel pitch: neither --pitch nor "pitch_mm""#),
        (r#"{"pitch": 0.5}"#, r#"a.json, which has "pitch""#),
        (r#"[0.5, null, null, null]"#, "unreadable sidecar"),
        (r#"{"pitch_mm": 0.5, "pitch_mm": 0.6}"#, "duplicate field `pitch_mm`"),
        (r#"{"pitch_mm": 1e39}"#, "pixel pitch inf mm"),
        (r#"{"pitch_mm": NaN}"#, "line 1 column 14"),
        ("", "unreadable sidecar"),
    ] {
        let error = open(sidecar).err().unwrap_or_else(|| panic!("{sidecar} is read")).to_string();
        assert!(error.contains(words) && error.lines().count() == 1, "{sidecar}: {error}");
    }
}

#[test]
fn nothing_unrelated_is_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npy");
    let json = sidecar_path(&path);
    check_capture_target(&path).unwrap();
    for unrelated in [r#"{"scripts": {"test": "exit 1"}}"#, "[1, 2]", "no JSON", r#"{"eta": 1.5}"#] {
        std::fs::write(&json, unrelated).unwrap();
        let error = check_capture_target(&path).unwrap_err().to_string();
        assert!(error.contains("a.json: is there and is no sidecar"), "{error}");
        let sidecar = subsurf_encoder::capture::Sidecar {
            pitch_mm: 0.5,
            addressing: Addressing::Clamp,
            eta: 1.5,
            simulated: None,
        };
        let writer = CaptureWriter { path: &path, size: [1, 1], radius: 0, scalar: Scalar::F32, sidecar: &sidecar };
        assert!(writer.write(|sink| sink(&[0.1; 3])).is_err(), "{unrelated}");
        assert_eq!(std::fs::read_to_string(&json).unwrap(), unrelated, "the file stays");
        assert!(!path.exists(), "no array without its sidecar");
    }
    // The sidecar of an earlier run is.
    std::fs::remove_file(&json).unwrap();
    capture(folder.path());
    capture(folder.path());
    for (name, words) in [("a.json", "name the array .npy"), ("a.npz", "name the array .npy")] {
        let error = check_capture_target(&folder.path().join(name)).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn no_mutation_of_a_sidecar_panics() {
    let folder = tempfile::tempdir().unwrap();
    let array = std::fs::read(capture(folder.path())).unwrap();
    let text = r#"{"pitch_mm": 0.5, "addressing": "repeat", "eta": 1.5, "simulated": {"seed": [1, 2e3]}}"#;
    let files = [text.as_bytes().to_vec(), utf16(text, u16::to_le_bytes)];
    let tally = assert_survives("a.json", &files, |path| {
        let npy = path.with_extension("npy");
        std::fs::write(&npy, &array).expect("a temporary folder can be written to");
        Capture::open(&npy, &Overrides::default())
    });
    println!("json: {tally:?}");
}
