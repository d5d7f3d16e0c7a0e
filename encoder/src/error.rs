//! What can go wrong, sorted by whose fault it is.

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
        /// The file.
        path: PathBuf,
        /// What is there.
        found: String,
        /// What should be there.
        expected: String,
    },
    /// A `.subsurf` file was refused by the decoder.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The decoder's reason.
        source: subsurf_decoder::ReadError,
    },
    /// The request itself makes no sense.
    #[error("{0}")]
    Request(String),
    /// Writing failed.
    #[error("{}: cannot write: {source}", path.display())]
    Output {
        /// The file that should have come to be.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

impl Error {
    pub(crate) fn input(path: &Path, found: impl Display, expected: impl Display) -> Self {
        Self::Input { path: path.to_owned(), found: found.to_string(), expected: expected.to_string() }
    }

    pub(crate) fn output(path: &Path, source: io::Error) -> Self {
        Self::Output { path: path.to_owned(), source }
    }

    /// Whether the input or the request is to blame, rather than this machine.
    #[must_use]
    pub fn is_callers(&self) -> bool {
        !matches!(self, Self::Output { .. })
    }
}
