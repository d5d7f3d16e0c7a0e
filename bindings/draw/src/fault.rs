//! Why a call of the renderer fails, and calls themselves: nothing but a status leaves them.

use std::panic::{AssertUnwindSafe, catch_unwind};

use subsurf_c::SubsurfStatus;
use subsurf_c::shared::{Failure, status_of};
use subsurf_runtime::{Error, Gpu};

/// Reason why a call fails.
pub(crate) enum Fault {
    /// What files can fail with, too.
    Failure(Failure<'static>),
    /// Status and text.
    Told(SubsurfStatus, String),
}

/// Result of what a call does.
pub(crate) type Result<T> = std::result::Result<T, Fault>;

impl From<Failure<'static>> for Fault {
    fn from(failure: Failure<'static>) -> Self {
        Self::Failure(failure)
    }
}

impl Fault {
    /// Mistake of the program.
    pub(crate) fn invalid(text: String) -> Self {
        Self::Told(SubsurfStatus::InvalidArgument, text)
    }

    /// What the renderer says, on a device if there is one.
    pub(crate) fn of(error: &Error, gpu: Option<&Gpu>) -> Self {
        let status = match error {
            Error::Read(_) => SubsurfStatus::InvalidFile,
            Error::Mesh(_) | Error::Scene(subsurf_scene::Error::Mesh(_)) => SubsurfStatus::InvalidMesh,
            Error::OverBudget { .. } => SubsurfStatus::OverBudget,
            Error::NoDevice { .. } => SubsurfStatus::NoDevice,
            Error::Unsupported { .. } | Error::NoHalfFloats { .. } => SubsurfStatus::Unsupported,
            Error::Surface(_) => SubsurfStatus::SurfaceLost,
            Error::Device(_) if gpu.is_some_and(|gpu| gpu.expect_alive().is_err()) => SubsurfStatus::DeviceLost,
            Error::Device(_) => SubsurfStatus::DeviceFailed,
            _ => SubsurfStatus::InvalidArgument,
        };
        Self::Told(status, one_line(&error.to_string()))
    }
}

/// Text of a driver in one line.
pub(crate) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Does what a call is for. Its failure becomes the thread's text; a panic, where panics unwind, is the failure of a driver or of
/// this library.
pub(crate) fn call(work: impl FnOnce() -> Result<()>) -> SubsurfStatus {
    let panicked =
        || Fault::Told(SubsurfStatus::DeviceFailed, "the renderer panicked; its message is on stderr".to_owned());
    match catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Err(panicked())) {
        Ok(()) => SubsurfStatus::Ok,
        Err(Fault::Failure(failure)) => status_of(Err(failure)),
        Err(Fault::Told(status, text)) => status_of(Err(Failure::Other { status, text: &text })),
    }
}
