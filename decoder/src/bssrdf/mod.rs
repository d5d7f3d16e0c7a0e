//! Diffuse BSSRDF of a flat patch (`FORMAT.md`, section 2): layout, reader, evaluation.

mod addressing;
pub mod basis;
mod evaluate;
#[cfg(feature = "push")]
mod exp2;
pub mod layout;
mod planes;
#[cfg(feature = "push")]
mod profile_table;
mod reader;
#[cfg(feature = "push")]
mod rows;
mod values;

pub use addressing::Addressing;
pub use basis::SeparableBasis;
pub use evaluate::{Knot, LocalProfile};
pub use layout::{BssrdfHeader, Coding};
pub use planes::{BaseMaterials, BssrdfModel, Mixture, Mixtures, PerPixelProfiles, Profiles};
#[cfg(feature = "push")]
pub use profile_table::ProfileTable;
pub use reader::Bssrdf;
#[cfg(feature = "push")]
pub(crate) use rows::BssrdfRows;
