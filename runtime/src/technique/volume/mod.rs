//! Light volumes: wide Gaussians spread the light that enters in cells in space, where the eye does not have to see it.

mod bound;
mod grid;
mod passes;

pub(crate) use bound::Volume;
pub(crate) use passes::{Maps, Passes};
