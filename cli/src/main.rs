//! The `subsurf` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    subsurf_cli::program::run("subsurf", subsurf_cli::run)
}
