//! Frames: sizes of their buffers within a budget, and their passes, recorded one after the other.

mod options;
pub(crate) mod plan;
mod renderer;

pub use options::{BACKGROUND, RuntimeOptions};
pub use plan::Plan;
pub use renderer::{Frame, Renderer};
