//! Captures where nothing was measured: heterogeneous diffusion in a slab.

pub mod analytic;
pub mod btf;
pub mod fresnel;
mod grid;
pub mod maps;
pub mod medium;
mod noise;
mod recipe;
mod run;
mod scene;
mod sensor;
mod slab;
mod solver;

pub use medium::Medium;
pub use run::{Finish, Summary, expose, simulate};
pub use scene::Scene;
pub use sensor::Sensor;
pub use slab::{MediumMap, Slab};
