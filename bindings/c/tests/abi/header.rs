//! `subsurf.h`, which cbindgen writes from the sources.

use std::path::Path;

use cbindgen::{Builder, Config, DocumentationStyle, EnumConfig, Language, RenameRule, Style};

use crate::library::bindings;

/// Sources of declarations, in the order in which the header has them.
const SOURCES: [&str; 7] = ["version", "failure", "file", "info", "plane", "bssrdf", "btf"];

/// Start of the header.
const INTRODUCTION: &str = "\
/* subsurf.h: .subsurf files for programs in C and C++.
 *
 * libsubsurf_decoder has these functions: it opens, describes and evaluates files, and draws nothing.
 *
 * Handles are opaque. Calls return a SubsurfStatus; after one that is not SUBSURF_STATUS_OK, subsurf_last_error says in one line what
 * was wrong, and nothing was written. Doc comments name statuses without their prefix. Pointers of arguments may have any
 * alignment and must not be null. Structs begin with struct_size, which the caller sets to its own sizeof, so that later
 * versions can append fields. No panic or exception leaves a function.
 *
 * Written by cbindgen from bindings/c/src; a test compares it. */";

fn generated() -> String {
    let config = Config {
        header: Some(INTRODUCTION.to_owned()),
        include_guard: Some("SUBSURF_H".to_owned()),
        language: Language::C,
        cpp_compat: true,
        style: Style::Type,
        no_includes: true,
        sys_includes: vec!["stddef.h".to_owned(), "stdint.h".to_owned()],
        documentation: true,
        documentation_style: DocumentationStyle::Doxy,
        line_length: 120,
        usize_is_size_t: true,
        enumeration: EnumConfig { rename_variants: RenameRule::QualifiedScreamingSnakeCase, ..EnumConfig::default() },
        ..Config::default()
    };
    let sources = bindings().join("c/src");
    let builder = SOURCES.iter().fold(Builder::new().with_config(config), |builder, name| {
        builder.with_src(sources.join(name).with_extension("rs"))
    });
    let mut header = Vec::new();
    builder.generate().expect("sources that cbindgen reads").write(&mut header);
    let header = String::from_utf8(header).expect("a text");
    // What Rust's lints want said of functions that C calls is said in their text.
    header.replace(" *\n * # Safety\n * As above.\n", "")
}

#[test]
fn the_header_is_that_of_the_sources() {
    let path = bindings().join("include/subsurf.h");
    let (found, expected) = (std::fs::read_to_string(&path).unwrap_or_default(), generated());
    if std::env::var_os("SUBSURF_WRITE_HEADER").is_some() {
        std::fs::write(&path, expected).expect("the header can be written");
        return;
    }
    assert!(
        found == expected,
        "{}: stale; SUBSURF_WRITE_HEADER=1 cargo test -p subsurf-c --test abi header",
        path.display()
    );
}

/// Names of the functions that the header declares.
pub(crate) fn functions(header: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(header).expect("the header");
    let is_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    let declared = text.lines().filter(|line| !line.starts_with([' ', '/', '#', '}']));
    let mut names: Vec<String> = declared
        .filter_map(|line| line.split_once('('))
        .filter_map(|(before, _)| before.rsplit(|c| !is_name(c)).next())
        .filter(|name| name.starts_with("subsurf_"))
        .map(str::to_owned)
        .collect();
    names.sort();
    names
}
