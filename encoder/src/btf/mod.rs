//! Bidirectional texture functions (BTFs): what a rough surface looks like from every side, under light from every side.
//!
//! [`encode()`] makes a file in one call; [`presets`] are the numbers that it uses where nothing is asked for. The parts
//! are here for those who want more: the decomposition that all encoders begin with ([`TruncatedSvd`]), and the encoders
//! themselves ([`nested`], [`factored`]).

mod encode;
pub mod factored;
mod materials;
mod memory;
pub(crate) mod mipmaps;
pub mod nested;
pub mod presets;
mod resample;
mod size;
mod truncated_svd;

pub use encode::{Encoded, Goal, Options, Setup, encode};
pub(crate) use materials::{common_tone, materials};
pub use resample::{Measured, Resampler};
pub use size::{Method, Size};
pub use truncated_svd::{Ranks, TruncatedSvd};
