//! Diffuse BSSRDF of a flat patch (`FORMAT.md`, section 2): layout, reader, evaluation.

mod addressing;
mod evaluate;
pub mod layout;
mod planes;
mod reader;

pub use addressing::Addressing;
pub use evaluate::{Knot, LocalProfile};
pub use layout::{Coding, Header};
pub use planes::{BaseMaterials, Mixture, Mixtures, Model, PerPixelProfiles, Profiles};
pub use reader::Bssrdf;
