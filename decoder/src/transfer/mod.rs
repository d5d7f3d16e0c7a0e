//! Transfer: scattering precomputed for every vertex of a mesh, for light from any direction (`FORMAT.md`, section 7).

mod evaluate;
pub mod layout;
mod reader;
#[cfg(feature = "push")]
mod rows;
mod weights;

pub use layout::TransferHeader;
pub use reader::Transfer;
#[cfg(feature = "push")]
pub(crate) use rows::TransferRows;
pub use weights::LightWeights;
