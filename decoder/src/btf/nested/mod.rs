//! Nested codebooks of luma and chroma (Havran, Filip and Myszkowski 2010, sections 4.2-4.5).

mod chain;
mod codebooks;
mod line;
mod reader;
mod sampler;
mod scale;
mod stage;
mod table;

pub use codebooks::{Codebooks, PackedTable, StageTables};
pub use reader::Nested;
pub use sampler::{Sample, Sampler};
