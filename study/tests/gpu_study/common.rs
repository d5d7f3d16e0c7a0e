//! The program, in a folder of its own.

use std::path::Path;
use std::process::Command;

use serde_json::Value;
use subsurf_tests::program::{Program, Run};

pub(crate) use subsurf_tests::program::{assert_refused, files};

const STUDY: Program = Program(env!("CARGO_BIN_EXE_subsurf-study"));

/// The program, to be given arguments.
pub(crate) fn command(folder: &Path) -> Command {
    STUDY.command(folder)
}

/// Runs with arguments separated by spaces.
pub(crate) fn run(folder: &Path, args: &str) -> Run {
    STUDY.run(folder, args)
}

/// Runs, and takes success for granted.
pub(crate) fn succeed(folder: &Path, args: &str) -> Run {
    STUDY.succeed(folder, args)
}

/// Runs, and takes JSON on stdout for granted.
pub(crate) fn json(folder: &Path, args: &str) -> Value {
    STUDY.json(folder, args)
}
