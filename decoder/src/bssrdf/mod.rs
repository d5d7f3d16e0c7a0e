//! Diffuse BSSRDF of a flat patch (`FORMAT.md`, section 2): layout, reader, evaluation.

mod addressing;
mod evaluate;
pub mod layout;
mod reader;

pub use addressing::Addressing;
pub use evaluate::{Knot, LocalProfile};
pub use layout::Header;
pub use reader::{BaseMaterials, Bssrdf, Model, PerPixelProfiles};
