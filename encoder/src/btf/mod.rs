//! Bidirectional texture functions: what a rough surface looks like from every side, under light from every side.

pub mod factored;
pub(crate) mod mipmaps;
pub mod nested;
pub(crate) mod resample;
pub(crate) mod truncated_svd;

pub use resample::{Measured, Resampler};
pub use truncated_svd::{Detail, Survey};
