//! The library without a renderer, as apps link it.

use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

use crate::compiler::{Library, bindings, run};

/// `libsubsurf_decoder`, which is built once, in the profile that apps get.
pub(crate) fn decoder() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("a folder in the target's");
        let mut build = Command::new(env!("CARGO"));
        build.args(["build", "--quiet", "--locked", "--profile", "bindings", "-p", "subsurf-c-decoder"]);
        run(build.arg("--target-dir").arg(target).current_dir(bindings()));
        Library { folder: target.join("bindings"), name: "subsurf_decoder" }
    })
}
