//! What the library exports, needs and weighs.

use std::process::Command;

use crate::header;
use crate::library::{bindings, library, run};

/// Largest size of the library for this machine, in bytes; that for phones is looked at by `scripts/android`.
const BUDGET: u64 = 120_000;

/// Lines of a tool of binutils or LLVM about the library; `None` where there is none, which is said.
fn tool(name: &str, args: &[&str]) -> Option<String> {
    if Command::new(name).arg("--version").output().is_err() {
        eprintln!("skipped: there is no {name}");
        return None;
    }
    Some(run(Command::new(name).args(args).arg(library())))
}

#[test]
fn the_library_exports_what_the_header_declares() {
    let Some(symbols) = tool("nm", &["-D", "--defined-only"]) else { return };
    let mut exported: Vec<&str> = symbols.lines().filter_map(|line| line.split_whitespace().last()).collect();
    exported.sort_unstable();
    assert_eq!(exported, header::functions(&bindings().join("include/subsurf.h")));
}

#[test]
fn the_library_cannot_panic_and_needs_libc_alone() {
    // A panic that a caller could cause would end in `abort`: the linker found no way there.
    let Some(symbols) = tool("nm", &["-D", "--undefined-only"]) else { return };
    let undefined: Vec<&str> = symbols.lines().filter_map(|line| line.split_whitespace().last()).collect();
    for name in &undefined {
        let name = name.split('@').next().unwrap_or_default();
        assert!(name != "abort" && !name.contains("Unwind") && !name.starts_with("__rust"), "{name} in {undefined:?}");
    }
    assert!(undefined.iter().any(|name| name.starts_with("malloc")), "malloc is not in {undefined:?}");
    if let Some(dynamic) = tool("readelf", &["-d"]) {
        for line in dynamic.lines().filter(|line| line.contains("(NEEDED)")) {
            assert!(line.contains("[libc.so"), "{line}");
        }
    }
}

#[test]
fn the_library_is_small() {
    let bytes = std::fs::metadata(library()).expect("the library").len();
    println!("{bytes} bytes");
    assert!(bytes <= BUDGET, "{bytes} bytes");
}
