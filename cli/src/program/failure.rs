//! One line on stderr, and the exit code that says whose fault it is.

use std::process::ExitCode;

/// A request that cannot be carried out, in one line that says what to do instead.
#[derive(Debug)]
pub(crate) struct BadRequest(pub(crate) String);

impl std::fmt::Display for BadRequest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for BadRequest {}

/// There is nothing to show pictures on, in one line that says why.
#[derive(Debug)]
pub(crate) struct NoDisplay(pub(crate) String);

impl std::fmt::Display for NoDisplay {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for NoDisplay {}

/// Shorthand for an error of the caller's making.
pub(crate) fn bad_request(message: impl Into<String>) -> anyhow::Error {
    anyhow::Error::new(BadRequest(message.into()))
}

const MACHINE: u8 = 1;
const INPUT: u8 = 2;
const NO_DEVICE: u8 = 3;

pub(crate) fn report(error: &anyhow::Error) -> ExitCode {
    eprintln!("subsurf: {}", line(error));
    ExitCode::from(code(error))
}

/// Causes on one line, without those that their parent already quotes.
pub(crate) fn line(error: &anyhow::Error) -> String {
    let mut line = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if !line.contains(&cause) {
            line = if line.is_empty() { cause } else { format!("{line}: {cause}") };
        }
    }
    line.replace('\n', " ")
}

fn code(error: &anyhow::Error) -> u8 {
    for cause in error.chain() {
        if cause.is::<BadRequest>() {
            return INPUT;
        }
        if cause.is::<NoDisplay>() {
            return NO_DEVICE;
        }
        if let Some(error) = cause.downcast_ref::<subsurf_encoder::Error>() {
            return if error.is_callers() { INPUT } else { MACHINE };
        }
        if let Some(error) = cause.downcast_ref::<subsurf_runtime::Error>() {
            use subsurf_runtime::Error::{Mesh, NoDevice, NoHalfFloats, Read, Unsupported};
            return match error {
                Read(_) | Mesh(_) => INPUT,
                NoDevice { .. } | NoHalfFloats { .. } | Unsupported { .. } => NO_DEVICE,
                _ => MACHINE,
            };
        }
    }
    MACHINE
}
