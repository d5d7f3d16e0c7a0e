//! Light in layered media by Monte Carlo, packet by packet.
//!
//! The physics are those of MCML (Wang, Jacques and Zheng 1995, *MCML: Monte Carlo modeling of light transport in
//! multi-layered tissues*): packets hop, drop weight, spin by Henyey and Greenstein's phase function, are reflected and
//! refracted by Fresnel at plane boundaries, and play roulette when little is left of them. [`Request`] is what one run
//! does, [`Outcome`] what was found, with standard errors; [`mcml`] reads and writes MCML's own files, and [`profile`]
//! gives the diffuse reflectance profiles R_d(r) of materials in three channels.
//!
//! [`voxels`] traces captures of heterogeneous slabs.
//!
//! Homogeneous half-spaces are traced many packets at once, and where scattering is isotropic packets jump through spheres.

mod beam;
mod half_space;
mod jumps;
mod lanes;
pub mod mcml;
mod outcome;
mod packet;
pub mod profile;
mod request;
mod roulette;
mod run;
mod score;
mod sphere;
mod stack;
mod voxel_lanes;
pub mod voxels;

pub use outcome::{Estimate, Outcome};
pub use request::Request;
pub use score::{Axes, Grid, Quantity, Score, Tally};
pub use stack::{Layer, Source, Stack};
