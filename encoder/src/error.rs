//! Errors, sorted by whose fault they are.

use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a capture, a file or a request was refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An input file is not what it should be.
    #[error("{}: {found}; expected {expected}", path.display())]
    Input {
        /// Path of the file.
        path: PathBuf,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A `.subsurf` file was refused by the decoder.
    #[error("{}: {source}", path.display())]
    Read {
        /// Path of the file.
        path: PathBuf,
        /// Reason of the decoder.
        source: subsurf_decoder::ReadError,
    },
    /// A request that makes no sense, or that nothing can meet; the text says what to ask for instead.
    #[error("{0}")]
    Request(String),
    /// The decoder refuses a file that was just made: a bug of this library, whatever it was given.
    #[error("the file that was just made cannot be read: {source}; this is a bug of subsurf, please report it")]
    OwnOutput {
        /// Reason of the decoder.
        source: subsurf_decoder::ReadError,
    },
    /// A file that could not be written.
    #[error("{}: cannot write: {source}", path.display())]
    Output {
        /// The file that should have come to be.
        path: PathBuf,
        /// Reason of the system.
        source: io::Error,
    },
}

/// Characters of what was found, at most.
const FOUND_CHARS: usize = 200;

/// Text from a file or about it, in one line that is not too long to read.
pub(crate) fn one_line(text: &str) -> String {
    let words: Vec<&str> =
        text.split(|c: char| c.is_whitespace() || c.is_control()).filter(|word| !word.is_empty()).collect();
    let line = words.join(" ");
    match line.char_indices().nth(FOUND_CHARS) {
        Some((end, _)) => format!("{} ..", &line[..end]),
        None => line,
    }
}

impl Error {
    pub(crate) fn input(path: &Path, found: impl Display, expected: impl Display) -> Self {
        Self::Input { path: path.to_owned(), found: one_line(&found.to_string()), expected: expected.to_string() }
    }

    pub(crate) fn output(path: &Path, source: io::Error) -> Self {
        Self::Output { path: path.to_owned(), source }
    }

    /// Whether the input or the request is to blame, rather than this machine or this library.
    #[must_use]
    pub fn is_callers(&self) -> bool {
        !matches!(self, Self::Output { .. } | Self::OwnOutput { .. })
    }
}
