//! Programs in C and C++ that draw by the library.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::synthetic::NestedShape;
use subsurf_runtime::Backend;
use subsurf_tests::drawable;
use subsurf_tests::program::under_display;
use tempfile::TempDir;

use crate::compiler::{Language, Library, bindings, run};
use crate::pictures;

const C: Language = Language::C("c11");
const CPP: Language = Language::Cpp("c++17");
/// APIs by the names that the programs know.
const BACKENDS: [(&str, Backend); 2] = [("vulkan", Backend::Vulkan), ("gl", Backend::Gl)];

/// `libsubsurf`, which cargo has built for the tests of its crate, beside this program.
pub(crate) fn runtime() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let program = std::env::current_exe().expect("a program");
        let library = Library { folder: program.parent().expect("a folder").to_owned(), name: "subsurf" };
        assert!(library.file().exists(), "{} is not there", library.file().display());
        library
    })
}

/// Programs and what they open.
struct Check {
    folder: TempDir,
    bssrdf: PathBuf,
    btf: PathBuf,
    /// `check.c` as C; `None` where there is no compiler.
    program: Option<PathBuf>,
}

/// Compiles a program of this folder.
fn compiled(language: Language, source: &Path, folder: &Path) -> Option<PathBuf> {
    language.is_here(folder, &[]).then(|| runtime().compile(language, source, &["-lm", "-ldl"], folder))
}

fn check() -> &'static Check {
    static CHECK: OnceLock<Check> = OnceLock::new();
    CHECK.get_or_init(|| {
        let folder = tempfile::tempdir().expect("temporary folders can be made");
        let file = |name: &str, bytes: Vec<u8>| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).expect("a temporary folder can be written to");
            path
        };
        let bssrdf = file("bssrdf.subsurf", drawable([9, 7], 2, Addressing::Clamp));
        let btf = file("btf.subsurf", NestedShape::small().database(2).to_bytes());
        let program = compiled(C, &bindings().join("runtime/tests/gpu_c_abi/check.c"), folder.path());
        Check { folder, bssrdf, btf, program }
    })
}

/// Runs `check.c` on both APIs.
fn run_check(arguments: impl Fn(&mut Command, &str)) {
    let Some(program) = &check().program else { return };
    for (name, _) in BACKENDS {
        let mut command = Command::new(program);
        arguments(&mut command, name);
        println!("{name}: {}", run(&mut command));
    }
}

#[test]
fn pictures_are_those_of_the_renderer() {
    let check = check();
    let Some(program) = &check.program else { return };
    for (name, backend) in BACKENDS {
        for (file, technique) in [(&check.bssrdf, 0), (&check.bssrdf, 1), (&check.bssrdf, 2), (&check.btf, 3)] {
            let out = check.folder.path().join("picture");
            run(Command::new(program).arg("picture").arg(file).arg(name).arg(technique.to_string()).arg(&out));
            let found = std::fs::read(&out).expect("a picture");
            let bytes = std::fs::read(file).expect("a file of our own");
            let expected = pictures::of(&bytes, backend, technique == 1);
            let differing = found.as_chunks().0.iter().zip(&expected).filter(|(found, expected)| found != expected);
            assert_eq!(found.len(), 4 * expected.len(), "a picture of that size");
            assert_eq!(differing.count(), 0, "{name}, technique {technique}");
            let covered = expected.iter().filter(|pixel| **pixel != expected[0]).count();
            assert!(covered > 1_000, "{covered} pixels are of the sphere");
        }
    }
}

#[test]
fn programs_in_cpp_draw_too() {
    let check = check();
    let folder = tempfile::tempdir().expect("temporary folders can be made");
    let source = bindings().join("runtime/tests/gpu_c_abi/check.c");
    let Some(program) = compiled(CPP, &source, folder.path()) else { return };
    run(Command::new(program)
        .arg("picture")
        .arg(&check.bssrdf)
        .args(["vulkan", "0"])
        .arg(folder.path().join("picture")));
}

#[test]
fn misuse_is_an_error_with_a_text() {
    let check = check();
    run_check(|program, backend| {
        program.arg("misuse").arg(&check.bssrdf).arg(backend).arg(&check.btf);
    });
}

#[test]
fn a_lost_device_is_an_error_and_another_one_draws_the_same() {
    run_check(|program, backend| {
        program.arg("lost").arg(&check().bssrdf).arg(backend);
    });
}

/// Opens four devices, and ten materials and meshes on each, one after the other.
#[test]
fn devices_and_materials_that_come_and_go_leave_nothing() {
    run_check(|program, backend| {
        // A handle that stays in every cycle is a hundred bytes and more.
        program.arg("cycles").arg(&check().bssrdf).arg(backend).args(["4", "10", "65536"]);
        program.env("MALLOC_ARENA_MAX", "1");
    });
}

#[test]
fn windows_come_and_go() {
    let check = check();
    let source = bindings().join("runtime/tests/gpu_c_abi/windows.c");
    let Some(program) = compiled(C, &source, check.folder.path()) else { return };
    for (name, _) in BACKENDS {
        let shown = under_display(program.to_str().expect("a path in UTF-8"), |test| {
            test.arg(&check.bssrdf).args([name, "100"]).env("MALLOC_ARENA_MAX", "1");
        });
        let Some(shown) = shown else {
            println!("skipped: there is no xvfb-run; apt-get install xvfb");
            return;
        };
        assert_eq!(shown.code, 0, "{name}: {}{}", shown.out, shown.err);
        println!("{name}: {}", shown.out);
    }
}

#[test]
fn the_example_in_c_draws_a_picture() {
    let check = check();
    let source = bindings().join("examples/draw.c");
    let lines = std::fs::read_to_string(&source).expect("an example").lines().count();
    assert!(lines <= 40, "{lines} lines");
    let folder = tempfile::tempdir().expect("temporary folders can be made");
    let Some(program) = compiled(C, &source, folder.path()) else { return };
    run(Command::new(program).arg(&check.bssrdf).current_dir(folder.path()));
    let picture = std::fs::read(folder.path().join("picture.ppm")).expect("a picture");
    assert!(picture.starts_with(b"P6 320 240 255\n") && picture.len() == 15 + 3 * 320 * 240, "a picture of that size");
}
