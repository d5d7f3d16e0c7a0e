//! Captures where nothing was measured.
//!
//! [`diffusion`] simulates translucent slabs, [`monte_carlo`] layers photon by photon, [`relief`] rough surfaces.

pub mod diffusion;
pub mod fresnel;
pub mod monte_carlo;
mod noise;
pub mod relief;
