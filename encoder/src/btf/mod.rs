//! Bidirectional texture functions: what a rough surface looks like from every side, under light from every side.

mod directions;
mod folder;
mod merl;
mod ubo;

pub use directions::{Direction, bonn};
use directions::{directions_of, image_name};
pub use folder::{Folder, FolderWriter, Pixels};
pub use merl::Merl;
pub use ubo::Ubo;
