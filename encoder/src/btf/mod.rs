//! Bidirectional texture functions: what a rough surface looks like from every side, under light from every side.

mod directions;
mod folder;

pub use directions::{Direction, bonn, image_name};
pub use folder::{FolderWriter, Pixels};
