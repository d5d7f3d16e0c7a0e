//! What the library exports, needs and weighs.

use crate::compiler::bindings;
use crate::header;
use crate::library::decoder;

/// Largest size of the library for this machine, in bytes; that for phones is looked at by `scripts/android`.
const BUDGET: u64 = 120_000;

#[test]
fn the_library_exports_what_the_header_declares() {
    let Some(exported) = decoder().exports() else { return };
    assert_eq!(exported, header::functions(&bindings().join("include/subsurf.h"), true));
}

#[test]
fn the_library_cannot_panic_and_needs_libc_alone() {
    // A panic that a caller could cause would end in `abort`: the linker found no way there.
    let Some(symbols) = decoder().tool("nm", &["-D", "--undefined-only"]) else { return };
    let undefined: Vec<&str> = symbols.lines().filter_map(|line| line.split_whitespace().last()).collect();
    for name in &undefined {
        let name = name.split('@').next().unwrap_or_default();
        assert!(name != "abort" && !name.contains("Unwind") && !name.starts_with("__rust"), "{name} in {undefined:?}");
    }
    assert!(undefined.iter().any(|name| name.starts_with("malloc")), "malloc is not in {undefined:?}");
    if let Some(dynamic) = decoder().tool("readelf", &["-d"]) {
        for line in dynamic.lines().filter(|line| line.contains("(NEEDED)")) {
            assert!(line.contains("[libc.so"), "{line}");
        }
    }
}

#[test]
fn the_library_is_small() {
    let bytes = std::fs::metadata(decoder().file()).expect("the library").len();
    println!("{bytes} bytes");
    assert!(bytes <= BUDGET, "{bytes} bytes");
}
