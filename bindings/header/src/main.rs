//! Writes `subsurf.h` with cbindgen, or says whether it is what the sources say.

use std::path::Path;
use std::process::ExitCode;

use cbindgen::{Builder, Config, DocumentationStyle, EnumConfig, ExportConfig, Language, RenameRule, Style};

/// Sources of declarations of files, in the order in which the header has them.
const FILES: [&str; 7] = ["version", "failure", "file", "info", "plane", "bssrdf", "btf"];

/// Sources of declarations of the renderer.
const RENDERER: [&str; 9] =
    ["window", "gpu", "environment", "material", "mesh", "frame", "picture", "surface", "renderer"];

/// Enumerations whose numbers are handed in, so that no declaration has their types.
const HANDED_IN: [&str; 6] = [
    "SubsurfBackend",
    "SubsurfWindowSystem",
    "SubsurfTechnique",
    "SubsurfShape",
    "SubsurfLightKind",
    "SubsurfMapping",
];

/// Start of the header.
const INTRODUCTION: &str = "\
/* subsurf.h: .subsurf files for programs in C and C++.
 *
 * libsubsurf_decoder opens, describes and evaluates files, and draws nothing. libsubsurf has its functions too, and those of the
 * renderer: define SUBSURF_DECODER_ONLY before this header, and only those of libsubsurf_decoder are declared.
 *
 * Handles are opaque. Calls return a SubsurfStatus; after one that is not SUBSURF_STATUS_OK, subsurf_last_error says in one line what
 * was wrong, and nothing was written. Doc comments name statuses without their prefix. Pointers of arguments may have any
 * alignment and must not be null. Structs begin with struct_size, which the caller sets to its own sizeof, so that later
 * versions can append fields. Handles may be closed in any order: each keeps what it needs. No panic or exception leaves a function.
 *
 * Written by cbindgen from bindings/c/src and bindings/draw/src; scripts/lint compares it. */";

/// Declarations of some sources.
fn declarations(folder: &Path, sources: &[&str], config: Config) -> String {
    let builder = sources.iter().fold(Builder::new().with_config(config), |builder, name| {
        builder.with_src(folder.join(name).with_extension("rs"))
    });
    let mut header = Vec::new();
    builder.generate().expect("sources that cbindgen reads").write(&mut header);
    let header = String::from_utf8(header).expect("a text");
    // What Rust's lints want said of functions that C calls is said in their text.
    header.replace(" *\n * # Safety\n * As above.\n", "")
}

fn generated(bindings: &Path) -> String {
    let config = Config {
        language: Language::C,
        cpp_compat: true,
        style: Style::Type,
        no_includes: true,
        documentation: true,
        documentation_style: DocumentationStyle::Doxy,
        line_length: 120,
        usize_is_size_t: true,
        enumeration: EnumConfig { rename_variants: RenameRule::QualifiedScreamingSnakeCase, ..EnumConfig::default() },
        ..Config::default()
    };
    let files = Config {
        header: Some(INTRODUCTION.to_owned()),
        include_guard: Some("SUBSURF_H".to_owned()),
        sys_includes: vec!["stddef.h".to_owned(), "stdint.h".to_owned()],
        ..config.clone()
    };
    let export = ExportConfig { include: HANDED_IN.map(str::to_owned).to_vec(), ..ExportConfig::default() };
    let files = declarations(&bindings.join("c/src"), &FILES, files);
    let renderer = declarations(&bindings.join("draw/src"), &RENDERER, Config { export, ..config });
    let (declared, end) = files.rsplit_once("#endif").expect("an include guard");
    format!("{declared}#ifndef SUBSURF_DECODER_ONLY\n\n{}\n\n#endif  /* SUBSURF_DECODER_ONLY */\n\n#endif{end}", renderer.trim())
}

fn main() -> ExitCode {
    let bindings = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a folder of bindings/");
    let path = bindings.join("include/subsurf.h");
    let expected = generated(bindings);
    if std::env::args().nth(1).as_deref() == Some("--write") {
        return match std::fs::write(&path, expected) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("{}: {error}", path.display());
                ExitCode::FAILURE
            }
        };
    }
    if std::fs::read_to_string(&path).is_ok_and(|found| found == expected) {
        return ExitCode::SUCCESS;
    }
    eprintln!("{}: stale; cargo run --manifest-path bindings/header/Cargo.toml -- --write", path.display());
    ExitCode::FAILURE
}
