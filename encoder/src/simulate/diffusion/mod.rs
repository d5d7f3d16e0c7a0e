//! Captures where nothing was measured: heterogeneous diffusion in a slab.

pub mod analytic;
pub mod fresnel;
mod grid;
pub mod maps;
mod material;
pub mod medium;
mod patterns;
mod run;
mod sensor;
mod slab;
mod solver;

pub use material::Scene;
pub use medium::Medium;
pub use run::{Finish, Summary, expose, simulate};
pub use sensor::Sensor;
pub use slab::{MediumMap, Slab};
