//! Events: what other threads tell the window.

use super::job::JobResult;

/// Event of an [`EventLoop`](winit::event_loop::EventLoop) that runs a [`Viewer`](crate::Viewer).
pub struct Event(pub(super) EventKind);

/// Kind of an event.
#[allow(clippy::large_enum_variant, reason = "a few in flight at a time")]
pub(super) enum EventKind {
    /// Result of a job.
    Computed(JobResult),
    /// Loss of a device.
    DeviceLost {
        /// Number of the device; the first is 1.
        number: u32,
        /// Reason in the driver's words.
        reason: String,
    },
    /// Complaint of the device, in the driver's words.
    DeviceError(String),
}
