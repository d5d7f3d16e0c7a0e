//! The crates' examples run.

use std::path::{Path, PathBuf};
use std::process::Command;

use subsurf_encoder::synthetic::NestedShape;

/// Examples of all crates, by name.
fn examples() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let crates = std::fs::read_dir(root).unwrap().map(|entry| entry.unwrap().path().join("examples"));
    let files = crates.filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().map(|file| file.unwrap().path());
    // Folders beside them hold what belongs to one of them, and those in other languages have tests of their own.
    files
        .filter(|path| path.extension().is_some_and(|kind| kind == "rs"))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect()
}

/// Where cargo puts examples: `examples` beside the folder of this test's own executable.
fn folder() -> PathBuf {
    std::env::current_exe().unwrap().parent().unwrap().with_file_name("examples")
}

#[test]
fn examples_run() {
    let examples = examples();
    assert!(examples.len() >= 5, "{examples:?}");
    let temporary = tempfile::tempdir().unwrap();
    let btf = temporary.path().join("btf.subsurf");
    std::fs::write(&btf, NestedShape::typical().database(1).to_bytes()).unwrap();
    for name in examples {
        let mut command = Command::new(folder().join(&name));
        if name == "embed" {
            command.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("materials/jade.subsurf")).arg(&btf);
        }
        let output =
            command.output().unwrap_or_else(|error| panic!("{name}: {error}; `cargo build --examples` makes it"));
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(!output.stdout.is_empty(), "{name} says what it found");
    }
}
