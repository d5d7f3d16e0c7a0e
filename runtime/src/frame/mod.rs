//! Frames: what the host shows, sizes of their buffers within a budget, and their passes, recorded one after the other.

mod draw;
mod input;
mod options;
mod picture;
mod plan;
mod prepare;
mod renderer;
mod timed;

pub use input::{Input, Object, ShadowMap, Target};
pub use options::{BACKGROUND, BACKGROUND_COLOUR, RuntimeOptions};
pub use picture::{DepthTarget, PictureTarget};
pub use plan::Plan;
pub use prepare::Frame;
pub(crate) use prepare::Placed;
pub use renderer::Renderer;
pub use timed::PassTimes;
