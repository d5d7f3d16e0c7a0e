//! Lights, the environment, and which vertices a light reaches.

#[cfg(feature = "bake")]
mod ambient;
mod environment;
mod source;
mod transfer;
#[cfg(feature = "bake")]
mod visibility;

pub use environment::{Environment, REFLECTION_LEVELS, REFLECTION_SIZE};
pub use source::{Light, LightShape, MAX_LIGHTS, Shadow};
pub use transfer::AmbientTransfer;
#[cfg(feature = "bake")]
pub use visibility::{Occluder, visibility};
