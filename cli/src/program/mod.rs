//! What every program of this workspace does around its work: start, progress, interruptions, failure and exit codes.

pub mod failure;
pub mod interrupt;
pub mod memory;
pub mod output;
pub mod progress;
pub mod threads;
pub mod warnings;

use std::process::ExitCode;
use std::sync::OnceLock;

use clap::Parser;

static NAME: OnceLock<&str> = OnceLock::new();

/// Name of the running program, for its messages.
fn name() -> &'static str {
    NAME.get().copied().unwrap_or("subsurf")
}

/// Runs a program: parses its arguments, does its work, and reports a failure in one line on stderr.
///
/// Call it first in `main`: it sets environment variables, which no other thread may read meanwhile.
///
/// Exit codes: 0 done, 1 this machine failed, 2 the input or the request is wrong, 3 there is no device that can do it,
/// 130 interrupted or terminated.
pub fn run<A: Parser>(name: &'static str, work: impl FnOnce(A) -> anyhow::Result<()>) -> ExitCode {
    // Once in a process: there is nothing to replace.
    let _ = NAME.set(name);
    crate::devices::settle_drivers();
    interrupt::watch();
    let args = match A::try_parse() {
        Ok(args) => args,
        Err(error) => return failure::report_arguments(&error),
    };
    match threads::check_environment().and_then(|()| work(args)) {
        Ok(()) if interrupt::came() => ExitCode::from(interrupt::INTERRUPTED),
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failure::report(&error),
    }
}
