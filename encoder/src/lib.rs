//! From captures and simulations of translucent and rough materials to `.subsurf` files.
//!
//! | module | what is in it |
//! |---|---|
//! | [`capture`] | readers of measured data: NumPy arrays, folders of BTF images, UBO2014, MERL, RGL |
//! | [`simulate`] | captures where nothing was measured: diffusion in a slab, rays on a relief |
//! | [`bssrdf`] | fits of K-BMPP to captures of subsurface scattering |
//! | [`btf`] | nested codebooks and factors of BTFs, and the presets of both |
//! | [`kernel`] | separable kernels of homogeneous diffusion profiles |
//! | [`transfer`] | scattering precomputed for the vertices of a mesh |
//! | [`rate`] | the smallest file of a quality, or the best of a size |
//! | [`metrics`] | the one judge of files: albedo error, PSNR, SSIM, MSSIM |
//! | [`baseline`] | earlier methods that only comparisons need, named by their papers |
//! | [`synthetic`] | materials without any meaning, for timing and for tests |
//! | [`picture`] | the one reader of pictures: maps, environments, images of BTFs |
//! | [`memory`] | what work may take |
//!
//! Files depend on their input and options alone, not on the number of threads. Every file is read back by the decoder
//! before it is handed out. Long work reports to a [`Progress`], which may also end it early and hears of what is left out
//! of an input or changed in it.
//!
//! A file from a capture:
//!
//! ```no_run
//! use subsurf_encoder::bssrdf::{Options, encode};
//! use subsurf_encoder::capture::{Capture, Overrides};
//!
//! let capture = Capture::open("jade.npy".as_ref(), &Overrides::default())?;
//! let encoded = encode(&capture, None, &Options::default(), &())?;
//! subsurf_encoder::write_bytes("jade.subsurf".as_ref(), &encoded.bytes)?;
//! # Ok::<(), subsurf_encoder::Error>(())
//! ```
//!
//! One from the images of a BTF, with the presets of the command:
//!
//! ```no_run
//! use subsurf_encoder::btf::{Options, encode};
//! use subsurf_encoder::capture::load_btf;
//!
//! let images = [load_btf("leather".as_ref(), &())?];
//! let encoded = encode(&images, &["leather".to_owned()], &Options::default(), &(), &mut |_| ())?;
//! subsurf_encoder::write_bytes("leather.subsurf".as_ref(), &encoded.bytes)?;
//! # Ok::<(), subsurf_encoder::Error>(())
//! ```

pub mod baseline;
pub mod bssrdf;
pub mod btf;
pub mod capture;
mod error;
mod file;
pub mod kernel;
mod math;
pub mod memory;
pub mod metrics;
pub mod picture;
mod progress;
pub mod rate;
pub mod simulate;
pub mod synthetic;
pub mod transfer;

pub use error::{Error, Result};
pub use file::metadata::{metadata_bytes, with_metadata};
pub use file::output::{Unfinished, check_target, remove_unfinished, write_atomically, write_bytes};
pub use progress::Progress;
