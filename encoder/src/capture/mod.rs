//! Readers of measured data, and writers of what is simulated in its place.
//!
//! Captures of subsurface scattering are NumPy arrays ([`Capture`]). BTFs are folders of images ([`Folder`]), files of
//! the database UBO2014 ([`Ubo`]), or isotropic BRDFs of MERL ([`Merl`]) and of RGL ([`Rgl`]); all of them are a [`Source`],
//! from which [`Images`] take everything into memory. A reader of another format is a folder here that implements
//! [`Source`], and a line in [`open_btf`].

mod bytes;
pub(crate) mod directions;
mod folder;
mod images;
mod isotropic;
mod merl;
mod npy;
mod open;
mod rgl;
mod source;
mod ubo;

pub use directions::{Direction, bonn};
pub use folder::{Folder, FolderWriter, Pixels};
pub use images::{Images, check_images};
pub use merl::Merl;
pub use npy::{
    Capture, CaptureWriter, Overrides, Scalar, Sidecar, check_capture_target, neighbour, sidecar_path, way_back,
};
pub use open::{is_btf, load_btf, open_btf};
pub use rgl::Rgl;
pub use source::Source;
pub use ubo::Ubo;
