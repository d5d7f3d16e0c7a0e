//! What can go wrong, sorted by whose fault it is.

use subsurf_decoder::ReadError;

use crate::gpu::Backend;

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Why something could not be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file is broken.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The mesh is broken or empty.
    #[error("mesh: {0}")]
    Mesh(String),
    /// What is drawn is broken, empty or too large.
    #[error(transparent)]
    Scene(#[from] subsurf_scene::Error),
    /// The images of a BTF cannot be drawn as they are.
    #[error("images of a BTF: {0}")]
    Images(String),
    /// What is asked for does not fit the budget; nothing was allocated.
    #[error("this takes {need_bytes} bytes on the device, more than the budget of {budget_bytes}")]
    OverBudget {
        /// What is used already and what is needed at least.
        need_bytes: u64,
        /// The budget.
        budget_bytes: u64,
    },
    /// There is no device of that kind.
    #[error("no {backend} device on this machine ({reason})")]
    NoDevice {
        /// What was asked for.
        backend: Backend,
        /// What the driver said.
        reason: String,
    },
    /// The device cannot hold or do something.
    #[error("the device takes {what} up to {have}; this needs {need}")]
    Unsupported {
        /// What it is about.
        what: &'static str,
        /// What is needed.
        need: u64,
        /// What the device has.
        have: u64,
    },
    /// Passes that keep values in half floats, on a device that cannot draw to them.
    #[error(
        "{what} need half floats to draw to, which this device does not offer (GL_EXT_color_buffer_half_float); meshes are \
         drawn without them by the gather and by the separable path, flat patches by the gather"
    )]
    NoHalfFloats {
        /// What it is about.
        what: &'static str,
    },
    /// The device or its driver failed.
    #[error("the device failed: {0}")]
    Device(String),
}
