//! What the library exports.

use crate::compiler::bindings;
use crate::header;
use crate::programs::runtime;

#[test]
fn the_library_exports_what_the_header_declares() {
    let Some(exported) = runtime().exports() else { return };
    let ours: Vec<String> = exported.into_iter().filter(|name| !name.starts_with("Java_")).collect();
    assert_eq!(ours, header::functions(&bindings().join("include/subsurf.h"), false));
}
