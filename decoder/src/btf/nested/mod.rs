//! Nested codebooks of luma and chroma (`FORMAT.md`, section 4; Havran, Filip and Myszkowski 2010, sections 4.2-4.5).

mod albedo;
mod codebooks;
mod evaluate;
pub mod layout;
mod offsets;
mod packed;
mod piecewise_linear;
mod reader;
#[cfg(feature = "push")]
mod rows;
mod sampler;
mod scale;
mod stage;
mod table;

pub use codebooks::NestedCodebooks;
pub use offsets::{CodebookOffsets, PackedTable, StageTables};
pub use reader::NestedBtf;
#[cfg(feature = "push")]
pub(crate) use rows::NestedRows;
pub use sampler::{Sample, Sampler};
