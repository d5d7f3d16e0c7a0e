//! Nested codebooks of luma and chroma (Havran, Filip and Myszkowski 2010, sections 4.2-4.5).

mod chroma;
mod database;
mod encode;
mod luma;
pub(crate) mod scales;
mod sizes;
mod slice_exponents;
pub(crate) mod slices;
mod write;

pub use chroma::ChromaSizes;
pub use database::{Chain, Chroma, Database, Item, slice_mean};
pub use encode::{Options, Prepared};
pub(crate) use sizes::check_stages;
pub use sizes::{Extent, Sizes};
