//! Bidirectional texture functions: what a rough surface looks like from every side, under light from every side.

pub mod baseline;
mod directions;
pub mod factored;
mod folder;
mod images;
mod merl;
mod mipmaps;
pub mod nested;
pub mod paper;
pub mod rate;
mod resample;
mod survey;
mod ubo;

pub use directions::{Direction, bonn};
use directions::{directions_of, image_name};
pub use folder::{Folder, FolderWriter, Pixels};
pub use images::{Images, Source};
pub use merl::Merl;
pub use resample::{Measured, Resampler};
pub use survey::{Detail, Factors, Survey};
pub use ubo::Ubo;
