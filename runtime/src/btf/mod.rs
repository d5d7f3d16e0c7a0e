//! Bidirectional texture functions on the device: the file itself, whose nested codebooks shaders read, or images.

mod images;
mod material;
mod query;

pub use images::BtfImages;
pub use material::BtfMaterial;
pub(crate) use material::slots;
pub use query::{BtfAnswer, BtfQueries, BtfQuery};
