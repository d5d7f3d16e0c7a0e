//! Reads `.subsurf` files: measured, heterogeneous, translucent materials in 48 bits per pixel, and the bidirectional
//! texture functions of rough ones in a few hundred kilobytes.
//!
//! [`Bssrdf::parse`] and [`Btf::parse`] check a file once and borrow it; after that nothing can fail. No `std`, no
//! allocation, no `unsafe`, no panic: any byte string yields a value or a [`ReadError`]. The input needs no alignment, and
//! the host may be of either endianness. Files are described byte by byte in `FORMAT.md`.
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
//!
//! ```
//! # fn show(file: &[u8]) -> Result<(), subsurf_decoder::ReadError> {
//! use subsurf_decoder::Btf;
//!
//! let cloth = Btf::parse(file)?;
//! if let Some(texel) = cloth.texel(0, 0, [3, 4]) {
//!     // What an eye 60° from the normal sees under light from above, and a light to look for next.
//!     let (light, eye) = ([0.0, 0.0, 1.0], [0.866, 0.0, 0.5]);
//!     let rgb = cloth.eval(texel, light, eye);
//!     let next = cloth.sample(texel, eye, [0.3, 0.7]);
//! #   let _ = (rgb, next);
//! # Ok(()) }
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

pub mod bssrdf;
pub mod btf;
pub mod container;
mod error;

pub use bssrdf::Bssrdf;
pub use btf::{Btf, Evaluate, Factored};
pub use error::{ReadError, Section};
