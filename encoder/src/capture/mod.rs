//! Readers of measured data, and writers of what is simulated in its place.
//!
//! Captures of subsurface scattering are NumPy arrays ([`Capture`]). BTFs are folders of images ([`Folder`]), files of
//! the database UBO2014 ([`Ubo`]) or isotropic BRDFs of MERL ([`Merl`]); all three are a [`Source`], from which [`Images`]
//! take everything into memory. A reader of another format is a folder here that implements [`Source`], and a line in
//! [`load_btf`].

pub(crate) mod directions;
mod folder;
mod images;
mod merl;
mod npy;
mod open;
mod source;
mod ubo;

pub use directions::{Direction, bonn};
pub use folder::{Folder, FolderWriter, Pixels};
pub use images::Images;
pub use merl::Merl;
pub use npy::{
    Capture, CaptureWriter, Overrides, Scalar, Sidecar, check_capture_target, neighbour, sidecar_path, way_back,
};
pub use open::{is_btf, load_btf};
pub use source::Source;
pub use ubo::Ubo;
