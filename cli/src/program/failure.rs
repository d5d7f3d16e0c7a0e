//! One line on stderr, and the exit code that says whose fault it is.

use std::path::Path;
use std::process::ExitCode;

use clap::error::ErrorKind;
use subsurf_decoder::ReadError;

/// A request that cannot be carried out, in one line that says what to do instead.
#[derive(Debug)]
pub struct BadRequest(String);

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

/// An error of the caller's making: exit code 2.
pub fn bad_request(message: impl Into<String>) -> anyhow::Error {
    anyhow::Error::new(BadRequest(message.into()))
}

/// A file of ours that the decoder refuses, by its name.
pub(crate) fn read_error(path: &Path, source: ReadError) -> subsurf_encoder::Error {
    subsurf_encoder::Error::Read { path: path.to_owned(), source }
}

const MACHINE: u8 = 1;
const INPUT: u8 = 2;
const NO_DEVICE: u8 = 3;

/// Prints an error in one line on stderr, and says with which code the program is to end.
pub fn report(error: &anyhow::Error) -> ExitCode {
    eprintln!("{}: {}", super::name(), line(error));
    ExitCode::from(code(error))
}

/// Prints what is wrong with arguments in one line on stderr, or the help that was asked for, and says with which code the
/// program is to end.
pub(super) fn report_arguments(error: &clap::Error) -> ExitCode {
    if error.use_stderr() && error.kind() != ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        eprintln!("{}: {}", super::name(), arguments_line(&error.render().to_string()));
    } else {
        // Who asked for help need not read all of it.
        error.print().ok();
    }
    if error.use_stderr() { ExitCode::from(INPUT) } else { ExitCode::SUCCESS }
}

/// The paragraphs of an error of arguments on one line, with what it suggests, but without the usage: it is in the help.
fn arguments_line(text: &str) -> String {
    let joined = |paragraph: &str| paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    let paragraphs = text.split("\n\n").filter(|paragraph| !paragraph.starts_with("Usage:")).map(joined);
    let line = paragraphs.filter(|paragraph| !paragraph.is_empty()).collect::<Vec<_>>().join("; ");
    let line = line.strip_prefix("error: ").unwrap_or(&line);
    line.replace("; For more information, try '--help'.", "; --help tells more")
}

/// An error and its causes on one line, without those that their parent already quotes.
pub fn line(error: &anyhow::Error) -> String {
    subsurf_viewer::one_line(error.as_ref())
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
            return of_renderer(error);
        }
        if cause.is::<subsurf_scene::Error>() {
            return INPUT;
        }
        if let Some(error) = cause.downcast_ref::<subsurf_viewer::Error>() {
            use subsurf_viewer::Error::{File, NoDisplay, Open, Request, Runtime, Scene};
            match error {
                Open { .. } | File { .. } | Request(_) | Scene(_) => return INPUT,
                NoDisplay(_) => return NO_DEVICE,
                Runtime(error) => return of_renderer(error),
                // The cause decides.
                _ => {}
            }
        }
    }
    MACHINE
}

fn of_renderer(error: &subsurf_runtime::Error) -> u8 {
    use subsurf_runtime::Error::{Mesh, NoDevice, NoHalfFloats, Read, Scene, Unsupported};
    match error {
        Read(_) | Mesh(_) | Scene(_) => INPUT,
        NoDevice { .. } | NoHalfFloats { .. } | Unsupported { .. } => NO_DEVICE,
        _ => MACHINE,
    }
}
