//! Readers and writers of measured data.

pub(crate) mod directions;
mod folder;
mod images;
mod merl;
mod npy;
mod ubo;

pub use directions::{Direction, bonn};
pub use folder::{Folder, FolderWriter, Pixels};
pub use images::{Images, Source};
pub use merl::Merl;
pub use npy::{Capture, CaptureWriter, Overrides, Scalar, Sidecar, neighbour, sidecar_path, way_back};
pub use ubo::Ubo;
