//! Bidirectional texture functions (`FORMAT.md`, sections 4 and 5): what a rough surface looks like from every side, under
//! light from every side.

mod albedo;
mod angle;
mod catalog;
mod evaluate;
pub mod factored;
mod grid;
pub mod layout;
mod nested;
mod reader;
mod sections;
mod tone;

pub use catalog::{Catalog, Texel};
pub use evaluate::Evaluate;
pub use factored::{Expanded, Factored};
pub use grid::{Cell, Grid, Place, View};
pub use layout::{Header, Material, Model};
pub use nested::{Codebooks, Nested, PackedTable, Sample, Sampler, StageTables};
pub use reader::Btf;
pub use tone::{CHROMA, LUMA, Tone};
