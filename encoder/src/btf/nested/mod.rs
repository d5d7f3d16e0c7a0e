//! Nested codebooks of luma and chroma (Havran, Filip and Myszkowski 2010, sections 4.2-4.5).

mod chroma;
mod clusters;
mod encode;
mod luma;
mod means;
mod scales;
mod slices;
mod write;

pub use chroma::ChromaSizes;
pub use encode::{Options, encode};
pub use luma::Sizes;
pub use write::{Chain, Chroma, Database, Item, slice_mean};
