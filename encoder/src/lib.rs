//! From captures of heterogeneous subsurface scattering to `.subsurf` files.
//!
//! [`capture`] reads what was measured, [`simulate`] makes captures where none were, [`bssrdf`] fits per-pixel
//! profiles and K-BMPP, [`rate`] looks for the best fit of a size, [`metrics`] judges the result.

pub mod baseline;
pub mod bssrdf;
pub mod btf;
pub mod capture;
mod error;
mod file;
mod math;
pub mod metrics;
mod progress;
pub mod rate;
pub mod simulate;
pub mod synthetic;

pub use error::{Error, Result};
pub use file::output::{Unfinished, check_target, remove_unfinished, write_atomically, write_bytes};
pub use progress::Progress;
