//! Errors, sorted by whose fault they are.

use std::path::PathBuf;

use subsurf_decoder::ReadError;

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Reason why something cannot be shown.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Material file that cannot be read from disk.
    #[error("{}: {source}; expected a .subsurf file", path.display())]
    Open {
        /// Name of the file.
        path: PathBuf,
        /// Reason of the operating system.
        source: std::io::Error,
    },
    /// Material file whose bytes are wrong.
    #[error("not a usable {kind}: {}: {source}", path.display())]
    File {
        /// Name of the file, for people.
        path: PathBuf,
        /// Kind that the file was taken for: "material" or "BTF".
        kind: &'static str,
        /// Reason of the decoder.
        source: ReadError,
    },
    /// Request that makes no sense, and what to do instead.
    #[error("{0}")]
    Request(String),
    /// Images of a BTF that cannot be had, as [`LoadImages`](crate::LoadImages) says.
    #[error("{0}")]
    Images(#[source] Box<dyn std::error::Error + Send + Sync>),
    /// Mesh or environment that cannot be used.
    #[error(transparent)]
    Scene(#[from] subsurf_scene::Error),
    /// Failure of the renderer: of the file, the device or the budget.
    #[error(transparent)]
    Runtime(#[from] subsurf_runtime::Error),
    /// Absence of a display or of a surface to show pictures on.
    #[error("{0}")]
    NoDisplay(String),
    /// Loss of the device, after which no other could be opened.
    #[error("the device was lost")]
    Lost(#[source] Box<Error>),
    /// Failure of the host to take a picture.
    #[error("{0}")]
    Host(#[source] Box<dyn std::error::Error + Send + Sync>),
}

/// The error and its causes in one line, without those that their parent already quotes.
#[must_use]
pub fn one_line(error: &(dyn std::error::Error + 'static)) -> String {
    let mut line = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let text = error.to_string();
        if !line.contains(&text) {
            line = format!("{line}: {text}");
        }
        cause = error.source();
    }
    line.replace('\n', " ")
}
