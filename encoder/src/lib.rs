//! From captures of heterogeneous subsurface scattering to `.subsurf` files.
//!
//! [`capture`] reads what was measured, [`simulate`] makes captures where none were, [`bssrdf`] fits per-pixel
//! profiles and K-BMPP, [`rate`] looks for the best fit of a size, [`metrics`] judges the result.

pub mod bssrdf;
pub mod btf;
pub mod capture;
mod container;
mod error;
pub mod metrics;
mod output;
mod progress;
pub mod rate;
pub mod simulate;
pub mod synthetic;

pub use error::{Error, Result};
pub use output::{Unfinished, check_target, remove_unfinished, write_atomically, write_bytes};
pub use progress::Progress;
