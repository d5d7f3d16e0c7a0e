//! Programs in C and C++ that use the library, with sanitizers where the compiler has them.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use tempfile::TempDir;

use crate::compiler::{Language, bindings, run};
use crate::library::decoder;
use crate::{expected, files};

/// Oldest standards that the header is for.
const C: Language = Language::C("c99");
const CPP: Language = Language::Cpp("c++11");

/// Memory errors, undefined behaviour and leaks end the program.
const SANITIZERS: [&str; 2] = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"];

/// `check.c`, with sanitizers and without; `None` where there is no C compiler.
struct Check {
    folder: TempDir,
    sanitized: Option<PathBuf>,
    plain: Option<PathBuf>,
}

fn check() -> &'static Check {
    static CHECK: OnceLock<Check> = OnceLock::new();
    CHECK.get_or_init(|| {
        let folder = tempfile::tempdir().expect("temporary folders can be made");
        let source = bindings().join("c/tests/abi/check.c");
        let build = |name: &str, options: &[&str]| {
            let folder = folder.path().join(name);
            std::fs::create_dir(&folder).expect("a temporary folder can be written to");
            C.is_here(&folder, options).then(|| decoder().compile(C, &source, options, &folder))
        };
        let (sanitized, plain) = (build("sanitized", &SANITIZERS), build("plain", &[]));
        Check { folder, sanitized, plain }
    })
}

impl Check {
    /// The program that tells most.
    fn strictest(&self) -> Option<Command> {
        self.sanitized.as_ref().or(self.plain.as_ref()).map(Command::new)
    }
}

#[test]
fn values_are_those_of_the_decoder() {
    let check = check();
    for path in files::all(check.folder.path()) {
        let Some(mut program) = check.strictest() else { return };
        let found = run(program.arg("values").arg(&path));
        let bytes = std::fs::read(&path).expect("a file that is there");
        assert_eq!(found, expected::of(&bytes), "{}", path.display());
    }
}

#[test]
fn misuse_is_an_error_with_a_text() {
    let folder = tempfile::tempdir().expect("temporary folders can be made");
    let Some(mut program) = check().strictest() else { return };
    run(program.arg("misuse").arg(files::bssrdf()).args(files::btfs(folder.path())));
}

#[test]
fn hostile_files_are_errors_or_values() {
    let folder = tempfile::tempdir().expect("temporary folders can be made");
    for path in files::btfs(folder.path()).into_iter().chain([files::bssrdf()]) {
        let Some(mut program) = check().strictest() else { return };
        run(program.arg("hostile").arg(path));
    }
}

#[test]
fn a_thousand_files_one_after_the_other_leave_nothing() {
    let folder = tempfile::tempdir().expect("temporary folders can be made");
    for path in files::btfs(folder.path()).into_iter().chain([files::bssrdf()]) {
        let asset_path = files::asset(folder.path(), &std::fs::read(&path).expect("a file that is there"));
        // Cycles, and pages of growth: the kernel counts them in lots of 64, and 900 handles that stay would be 1,400.
        // Sanitizers keep memory that was freed for a while, but find leaks of a byte.
        for (program, limits) in [(&check().plain, ["1000", "256"]), (&check().sanitized, ["20", "5000"])] {
            let Some(program) = program else { continue };
            run(Command::new(program).arg("cycles").args(limits).arg(&path).arg(&asset_path));
        }
    }
}

/// An asset of 40 MB: its pages are those of the file, however much of it is looked at.
#[test]
#[cfg(target_os = "linux")]
fn mapped_files_are_not_copied() {
    let folder = tempfile::tempdir().expect("temporary folders can be made");
    if !C.is_here(folder.path(), &[]) {
        return;
    }
    let (asset, length) = files::large_asset(folder.path());
    let program = decoder().compile(C, &bindings().join("c/tests/abi/mapped.c"), &[], folder.path());
    let said = run(Command::new(program).arg(asset).args([files::ASSET_OFFSET, length].map(|bytes| bytes.to_string())));
    println!("{said}");
}

/// Compiles an example, runs it on a file, and returns what it says; `None` where there is no compiler.
fn example(language: Language, name: &str, file: &Path) -> Option<String> {
    let folder = tempfile::tempdir().expect("temporary folders can be made");
    let options: &[&str] = if language.is_here(folder.path(), &SANITIZERS) { &SANITIZERS } else { &[] };
    if !language.is_here(folder.path(), options) {
        return None;
    }
    let source = bindings().join("examples").join(name);
    let lines = std::fs::read_to_string(&source).expect("an example").lines().count();
    assert!(lines <= 40, "{name} has {lines} lines");
    Some(run(Command::new(decoder().compile(language, &source, options, folder.path())).arg(file)))
}

#[test]
fn the_example_in_c_describes_a_patch() {
    let Some(said) = example(C, "describe.c", &files::bssrdf()) else { return };
    for words in
        ["216 bytes, family 1", "2 x 1 pixels of 0.5 mm, 48 bits", "plane 3: 2 x 1 x 1, GL format 0x8238, Vulkan 20"]
    {
        assert!(said.contains(words), "\"{words}\" is not in: {said}");
    }
}

#[test]
fn the_example_in_cpp_evaluates_btfs() {
    let folder = tempfile::tempdir().expect("temporary folders can be made");
    for file in files::btfs(folder.path()) {
        let Some(said) = example(CPP, "evaluate.cpp", &file) else { return };
        assert!(said.starts_with("linear RGB of texel 4: "), "{said}");
    }
}
