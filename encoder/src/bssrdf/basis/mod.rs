//! Separable basis of a material (`FORMAT.md`, section 2.7): fitted when a file is written, so that nothing is left to fit when
//! it is drawn.
//!
//! All numbers are fitted together to what is seen of the file: its gather under some lights.

mod add;
mod choose;
mod descend;
mod fitted;
mod lights;
mod nodes;
mod normal;
mod params;
mod patch;
mod render;
mod rings;
mod start;
mod targets;

pub use add::{add_basis, basis_bytes, with_basis};
pub use choose::{BasisChoice, BasisOptions, fit_basis};
pub use fitted::FittedBasis;
