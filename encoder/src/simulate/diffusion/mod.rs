//! Captures of subsurface scattering in a heterogeneous slab, by diffusion or photon by photon.
//!
//! A [`BuiltinMaterial`] or an artist's images ([`maps`]) give the media below every pixel ([`MediumMap`]); [`Request`]
//! simulates what a camera and a projector would measure, and writes a capture.

pub mod analytic;
mod grid;
pub mod maps;
mod material;
pub mod medium;
mod patterns;
mod request;
mod run;
mod sensor;
mod slab;
mod solver;

pub use material::BuiltinMaterial;
pub use medium::Medium;
pub use request::{Method, Request, check_patch};
pub use run::{Finish, Summary, expose, simulate};
pub use sensor::Sensor;
pub use slab::{MediumMap, Slab};
