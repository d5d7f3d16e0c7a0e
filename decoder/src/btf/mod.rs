//! Bidirectional texture functions (`FORMAT.md`, section 4): what a rough surface looks like from every side, under light
//! from every side.

mod albedo;
mod angle;
mod grid;
pub mod layout;
mod nested;
mod reader;
mod sections;
mod tone;

pub use grid::{Cell, Grid, Place, View};
pub use layout::{Header, Material, Model};
pub use nested::{Codebooks, Nested, PackedTable, Sample, Sampler, StageTables};
pub use reader::{Btf, Texel};
pub use tone::{CHROMA, LUMA, Tone};
