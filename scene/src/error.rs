//! Errors, each with what is wrong, where, and what to do.

use std::path::PathBuf;

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Reason why a mesh or an environment cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A mesh that is broken or empty.
    #[error("mesh: {0}")]
    Mesh(String),
    /// A picture of an environment that is broken or empty.
    #[error("environment: {0}")]
    Environment(String),
    /// A file that is no mesh, or whose mesh is broken.
    #[error("{}: {reason}", path.display())]
    File {
        /// Where it was read from.
        path: PathBuf,
        /// What is wrong, and what was expected.
        reason: String,
    },
}
