//! The command, in a folder of its own.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use subsurf_tests::program::{Program, Run};

pub(crate) use subsurf_tests::program::{assert_refused, files, finish, under_display, without_display};

pub(crate) const SUBSURF: Program = Program(env!("CARGO_BIN_EXE_subsurf"));

/// The command, to be given arguments.
pub(crate) fn command(folder: &Path) -> Command {
    SUBSURF.command(folder)
}

/// Runs with arguments separated by spaces.
pub(crate) fn run(folder: &Path, args: &str) -> Run {
    SUBSURF.run(folder, args)
}

/// Runs, and takes success for granted.
pub(crate) fn succeed(folder: &Path, args: &str) -> Run {
    SUBSURF.succeed(folder, args)
}

/// Runs, and takes JSON on stdout for granted.
pub(crate) fn json(folder: &Path, args: &str) -> Value {
    SUBSURF.json(folder, args)
}

/// A tiny simulated capture, `NAME.npy`.
pub(crate) fn simulate(folder: &Path, name: &str) -> PathBuf {
    succeed(folder, &format!("simulate --material chessboard --size 9x7 --window 5 --thickness 5 -o {name}.npy"));
    folder.join(format!("{name}.npy"))
}
