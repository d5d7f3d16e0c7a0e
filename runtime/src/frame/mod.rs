//! A frame: how large its buffers are within a budget, and its passes, recorded one after the other.

mod drawable;
mod options;
pub(crate) mod plan;
mod renderer;

pub use drawable::{Drawable, Technique};
pub use options::{BACKGROUND, RuntimeOptions};
pub use plan::Plan;
pub use renderer::{Frame, Renderer};
