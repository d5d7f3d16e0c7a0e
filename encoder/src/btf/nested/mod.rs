//! Nested codebooks of luma and chroma (Havran, Filip and Myszkowski 2010, sections 4.2-4.5).

mod chroma;
mod clusters;
mod encode;
mod heights;
mod luma;
mod means;
pub(super) mod scales;
mod sizes;
pub(super) mod slices;
mod write;

pub use chroma::ChromaSizes;
pub(super) use encode::materials;
pub use encode::{Options, Prepared};
pub use sizes::{Extent, Sizes};
pub use write::{Chain, Chroma, Database, Item, slice_mean};
