//! Reads `.subsurf` files: measured, heterogeneous, translucent materials in 48 bits per pixel.
//!
//! [`Bssrdf::parse`] checks a file once and borrows it; after that nothing can fail. No `std`, no allocation, no
//! `unsafe`, no panic: any byte string yields a value or a [`ReadError`]. The input needs no alignment, and the host
//! may be of either endianness. The file is described byte by byte in `FORMAT.md`.
//!
//! ```
//! # fn show(file: &[u8]) -> Result<(), subsurf_decoder::ReadError> {
//! use subsurf_decoder::Bssrdf;
//!
//! let material = Bssrdf::parse(file)?;
//! // Light that enters at pixel (3, 4) and leaves at pixel (5, 4), in mm⁻².
//! let rd = material.rd([3, 4], [5, 4]);
//! # let _ = rd; Ok(()) }
//! # assert!(show(b"not a file").is_err());
//! ```
#![no_std]
#![forbid(unsafe_code)]
#![deny(
    clippy::arithmetic_side_effects,
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic
)]

pub mod bits;
pub mod bssrdf;
pub mod btf;
pub mod bytes;
pub mod container;
mod crc;
mod error;

pub use bssrdf::Bssrdf;
pub use btf::Btf;
pub use error::{ReadError, Section};
