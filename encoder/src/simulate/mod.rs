//! Captures where nothing was measured.

pub mod diffusion;
mod noise;
pub mod relief;
