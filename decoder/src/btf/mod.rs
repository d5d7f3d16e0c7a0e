//! Bidirectional texture functions (`FORMAT.md`, sections 4 and 5): what a rough surface looks like from every side, under
//! light from every side.

mod angle;
mod catalog;
mod colour;
mod coord;
mod evaluate;
pub mod factored;
mod grid;
pub mod layout;
mod material;
pub mod nested;
#[cfg(feature = "push")]
mod rows;

pub use catalog::{Catalog, Texel};
pub use colour::{CHROMA, ColourEncoding, LUMA};
pub use coord::{GridCoord, LerpCoord};
pub use evaluate::Evaluate;
pub use factored::{ExpandedBtf, FactoredBtf};
pub use grid::{Grid, View};
pub use layout::{BtfHeader, BtfModel};
pub use material::{MATERIAL_BYTES, Material, NAME_BYTES};
pub use nested::{CodebookOffsets, NestedBtf, NestedCodebooks, PackedTable, Sample, Sampler, StageTables};
