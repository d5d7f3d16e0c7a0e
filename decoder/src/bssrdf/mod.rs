//! Diffuse BSSRDF of a flat patch (`FORMAT.md`, section 2): layout, reader, evaluation.

mod addressing;
pub mod basis;
mod evaluate;
pub mod layout;
mod planes;
mod reader;
mod rows;
mod values;

pub use addressing::Addressing;
pub use basis::SeparableBasis;
pub use evaluate::{Knot, LocalProfile};
pub use layout::{BssrdfHeader, Coding};
pub use planes::{BaseMaterials, BssrdfModel, Mixture, Mixtures, PerPixelProfiles, Profiles};
pub use reader::Bssrdf;
pub(crate) use rows::BssrdfRows;
