//! Bidirectional texture functions: what a rough surface looks like from every side, under light from every side.

mod directions;
mod folder;

pub use directions::{Direction, bonn};
use directions::{directions_of, image_name};
pub use folder::{Folder, FolderWriter, Pixels};
