//! Bidirectional texture functions (`FORMAT.md`, sections 4 and 5): what a rough surface looks like from every side, under
//! light from every side.

mod angle;
mod catalog;
mod colour;
mod evaluate;
pub mod factored;
mod grid;
pub mod layout;
mod nested;

pub use catalog::{Catalog, Texel};
pub use colour::{CHROMA, LUMA, Tone};
pub use evaluate::Evaluate;
pub use factored::{Expanded, Factored};
pub use grid::{Cell, Grid, Place, View};
pub use layout::{Header, Material, Model};
pub use nested::{Btf, Codebooks, Nested, PackedTable, Sample, Sampler, StageTables};
