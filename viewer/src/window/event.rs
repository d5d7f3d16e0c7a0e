//! What other threads tell the window.

use super::job::JobResult;

/// Event of an [`EventLoop`](winit::event_loop::EventLoop) that runs a [`Viewer`](crate::Viewer).
pub struct Event(pub(super) EventKind);

/// What has happened.
#[allow(clippy::large_enum_variant, reason = "a few in flight at a time")]
pub(super) enum EventKind {
    /// A job is done.
    Computed(JobResult),
    /// The device of this number is gone.
    DeviceLost {
        /// The first device is 1.
        number: u32,
        /// The driver's words.
        reason: String,
    },
    /// The device complains.
    DeviceError(String),
}
