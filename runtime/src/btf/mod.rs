//! Bidirectional texture functions on the device: the file itself, and shaders that read its nested codebooks.

mod material;
mod query;

pub use material::BtfMaterial;
pub use query::{BtfAnswer, BtfQueries, BtfQuery};
