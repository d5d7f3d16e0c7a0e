//! Multiresolution splatting: light of samples that lights see, spread in space, ring by ring.
//!
//! The reach of scattering is cut into rings, each twice as wide as the one before. A wider ring takes its samples from a
//! coarser level of what the light sees, and adds them to a target of half the size: every ring costs about as many
//! fragments for each sample, and a quarter of the samples.

mod bound;
mod levels;
mod passes;

pub(crate) use bound::Maps;
pub use levels::SplatLevels;
pub(crate) use levels::divisor;
pub(crate) use passes::Passes;
