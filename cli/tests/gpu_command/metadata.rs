//! `--meta`: what files say of themselves.

use crate::common::{assert_refused, json, run, succeed};

const KERNEL: &str = "kernel --near 0.05/0.03/0.02 --far 1.2/0.4/0.2 --weight 0.5 -o k.subsurf";

#[test]
fn files_say_who_made_them() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed(folder, KERNEL);
    let plain = std::fs::metadata(folder.join("k.subsurf")).unwrap().len();
    assert_eq!(json(folder, "info k.subsurf --json")["metadata"], serde_json::json!({}));

    // The last of a key counts; a terminal does not obey what a file says.
    let entries = "--meta author=Ada --meta licence=CC0-1.0 --meta author=A=\u{1b}[2J";
    succeed(folder, &format!("{KERNEL} {entries}"));
    let found = &json(folder, "info k.subsurf --json")["metadata"];
    assert_eq!(*found, serde_json::json!({ "licence": "CC0-1.0", "author": "A=\u{1b}[2J" }));
    let shown = succeed(folder, "info k.subsurf").out;
    assert!(shown.contains("  licence: CC0-1.0\n  author: A=\\u{1b}[2J\n"), "{shown}");
    assert!(shown.contains("meta (metadata)"), "{shown}");
    // An entry of the section table, and four bytes before each key and value.
    let added = std::fs::metadata(folder.join("k.subsurf")).unwrap().len() - plain;
    assert_eq!(added, 24 + 2 * 4 + "licenceCC0-1.0authorA=\u{1b}[2J".len() as u64);
}

#[test]
fn damaged_metadata_leaves_the_file_good() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed(folder, &format!("{KERNEL} --meta author=Ada --meta source=\u{202e}gpj"));
    assert!(succeed(folder, "info k.subsurf").out.contains("  source: \\u{202e}gpj\n"), "no letter turns the line");
    let mut bytes = std::fs::read(folder.join("k.subsurf")).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    std::fs::write(folder.join("k.subsurf"), bytes).unwrap();
    assert_eq!(json(folder, "info k.subsurf --json")["metadata"], serde_json::Value::Null);
    let shown = succeed(folder, "info k.subsurf").out;
    assert!(shown.contains("  no metadata: meta (metadata): is damaged") && shown.contains("KWGT"), "{shown}");
}

#[test]
fn metadata_counts_for_targets_and_needs_a_key() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    assert_refused(&run(folder, &format!("{KERNEL} --meta Ada")), &["expected KEY=VALUE"]);
    assert_refused(&run(folder, &format!("{KERNEL} --meta =Ada")), &["no key before"]);
    let long = "x".repeat(500);
    let command =
        format!("transfer sphere --material marble --target-bytes-per-vertex 0.01 --meta source={long} -o t.subsurf");
    assert_refused(&run(folder, &command), &["the metadata of --meta alone takes up to 537"]);
}
