//! Errors, sorted by whose fault they are: the file, the scene, the caller, the budget, the device.

use subsurf_decoder::ReadError;

use crate::gpu::Backend;

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Reason why something could not be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// File that is broken.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Mesh that a technique cannot draw.
    #[error("mesh: {0}")]
    Mesh(String),
    /// Mesh or environment that is broken, empty or too large.
    #[error(transparent)]
    Scene(#[from] subsurf_scene::Error),
    /// Images of a BTF that cannot be drawn as they are.
    #[error("images of a BTF: {0}")]
    Images(String),
    /// More than the budget; nothing was allocated.
    #[error("this takes {need_bytes} bytes on the device, more than the budget of {budget_bytes}")]
    OverBudget {
        /// Bytes that are used already and those that are needed at least.
        need_bytes: u64,
        /// Bytes of the budget.
        budget_bytes: u64,
    },
    /// No device of that kind.
    #[error("no {backend} device on this machine ({reason})")]
    NoDevice {
        /// API that was asked for.
        backend: Backend,
        /// Words of the driver.
        reason: String,
    },
    /// Size that the device cannot hold.
    #[error("the device takes {what} up to {have}; this needs {need}")]
    Unsupported {
        /// Kind of the size.
        what: &'static str,
        /// Size that is needed.
        need: u64,
        /// Largest size of the device.
        have: u64,
    },
    /// Passes that need half floats to draw to, on a device that cannot draw to them.
    #[error(
        "{what} need half floats to draw to, which this device does not offer (GL_EXT_color_buffer_half_float); meshes and \
         flat patches are drawn without them by the gather and by the separable path"
    )]
    NoHalfFloats {
        /// Passes that were asked for.
        what: &'static str,
    },
    /// Mistake of the caller: things that do not belong together, or options out of range.
    #[error("{0}")]
    Usage(String),
    /// Surface of a window that shows no pictures, or not those that it showed before.
    #[error("the window's surface: {0}")]
    Surface(String),
    /// Device or driver that failed.
    #[error("the device failed: {0}")]
    Device(String),
}
