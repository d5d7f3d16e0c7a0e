//! Nested codebooks of luma and chroma (Havran, Filip and Myszkowski 2010, sections 4.2-4.5).

mod albedo;
mod codebooks;
mod evaluate;
mod offsets;
mod piecewise_linear;
mod reader;
mod sampler;
mod scale;
mod stage;
mod table;

pub use codebooks::Nested;
pub use offsets::{Codebooks, PackedTable, StageTables};
pub use reader::Btf;
pub use sampler::{Sample, Sampler};
