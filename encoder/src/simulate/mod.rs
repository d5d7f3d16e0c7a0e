//! Captures where nothing was measured.
//!
//! [`diffusion`] simulates translucent slabs, [`monte_carlo`] layers photon by photon, [`relief`] rough surfaces; [`burley`] is a
//! profile in closed form.

pub mod burley;
pub mod diffusion;
pub mod fresnel;
pub mod monte_carlo;
mod noise;
pub mod relief;
