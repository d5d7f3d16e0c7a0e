//! C functions around the decoder: what `bindings/include/subsurf.h` declares of files.
//!
//! Handles are opaque, calls return a [`SubsurfStatus`], and what went wrong is told by [`subsurf_last_error`]. Nothing
//! here panics, and on Unix nothing allocates by Rust's allocator: memory is malloc's, files are mapped, and everything else is
//! the decoder.
#![cfg_attr(unix, no_std)]
#![deny(
    clippy::arithmetic_side_effects,
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    unsafe_op_in_unsafe_fn
)]

mod border;
mod bssrdf;
mod btf;
mod extent;
mod failure;
mod file;
mod handle;
mod info;
mod line;
#[cfg_attr(unix, path = "map/unix.rs")]
#[cfg_attr(windows, path = "map/windows.rs")]
mod map;
mod memory;
mod plane;
#[cfg_attr(unix, path = "text/unix.rs")]
#[cfg_attr(windows, path = "text/windows.rs")]
mod text;
mod version;

/// What the functions of other crates stand on: the border to C, handles, failures. For the crates of `bindings/` alone.
#[doc(hidden)]
pub mod shared {
    pub use crate::border::{Versioned, fill, in_memory, not_null, read, read3, sized, write};
    pub use crate::failure::{Failure, status_of};
    pub use crate::file::OpenFile;
    pub use crate::handle::{Handle, Kind};
}

pub use bssrdf::{subsurf_bssrdf_albedo, subsurf_bssrdf_rd};
pub use btf::{
    subsurf_btf_albedo, subsurf_btf_eval, subsurf_btf_expand, subsurf_btf_linear, subsurf_btf_pdf, subsurf_btf_sample,
    subsurf_btf_texel,
};
pub use failure::{SubsurfStatus, subsurf_last_error};
pub use file::{
    SUBSURF_TO_END, SubsurfFile, subsurf_file_bytes, subsurf_file_close, subsurf_file_open_fd,
    subsurf_file_open_memory, subsurf_file_open_path,
};
pub use info::{
    SubsurfAddressing, SubsurfBssrdfInfo, SubsurfBtfInfo, SubsurfBtfMaterial, SubsurfCoding, SubsurfFamily,
    SubsurfFileInfo, subsurf_bssrdf_info, subsurf_btf_info, subsurf_btf_material, subsurf_file_info,
};
pub use plane::{SubsurfFormat, SubsurfPlane, SubsurfPlaneKind, subsurf_bssrdf_plane};
pub use version::{SUBSURF_ABI_VERSION, subsurf_abi_version};
