//! Lights, the environment, and which vertices a light reaches.

mod environment;
mod source;
mod visibility;

pub use environment::{Environment, REFLECTION_LEVELS, REFLECTION_SIZE};
pub use source::{Light, LightShape, MAX_LIGHTS};
pub use visibility::visibility;
