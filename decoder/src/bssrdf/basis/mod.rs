//! Separable basis of a material (`FORMAT.md`, section 2.7): its numbers, the cascade that blurs by its Gaussians.

mod blur;
mod cascade;
mod layout;
mod reader;
#[cfg(feature = "push")]
mod rows;

pub use cascade::{Cascade, CascadeStage};
pub use layout::{BasisSize, MAX_GAUSSIANS, MAX_PAIRS_OF_TERMS, MAX_PROJECTION, MAX_TERMS, MAX_WEIGHT, WIDTHS};
pub use reader::SeparableBasis;
#[cfg(feature = "push")]
pub(super) use rows::BasisRows;
