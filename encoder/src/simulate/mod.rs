//! Captures where nothing was measured.
//!
//! [`diffusion`] simulates translucent slabs, [`relief`] rough surfaces.

pub mod diffusion;
mod noise;
pub mod relief;
