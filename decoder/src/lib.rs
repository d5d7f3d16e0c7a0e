//! Reads `.subsurf` files: measured, heterogeneous, translucent materials in 48 bits per pixel, the bidirectional
//! texture functions of rough ones in a few hundred kilobytes, and the separable kernels of even ones in a few thousand bytes.
//!
//! [`File::parse`] checks a file of any family once and borrows it; after that nothing can fail. Who knows the family
//! calls [`Bssrdf::parse`], [`NestedBtf::parse`], [`FactoredBtf::parse`] or [`Kernel::parse`]. No `std`, no allocation, no `unsafe`, no panic:
//! any byte string yields a value or a [`ReadError`]. The input needs no alignment, and the host may be of either
//! endianness. Files are described byte by byte in `FORMAT.md`.
//!
//! ```
//! # fn show(file: &[u8]) -> Result<(), subsurf_decoder::ReadError> {
//! use subsurf_decoder::{Content, File};
//!
//! match File::parse(file)?.content() {
//!     Content::Bssrdf(material) => {
//!         // Light that enters at pixel (3, 4) and leaves at pixel (5, 4), in mm⁻².
//!         let rd = material.rd([3, 4], [5, 4]);
//! #       let _ = rd;
//!     }
//!     Content::NestedBtf(cloth) => {
//!         if let Some(texel) = cloth.texel(0, 0, [3, 4]) {
//!             // What an eye 60° from the normal sees under light from above, and a light to look for next.
//!             let (light, eye) = ([0.0, 0.0, 1.0], [0.866, 0.0, 0.5]);
//!             let rgb = cloth.eval(texel, light, eye);
//!             let next = cloth.sample(texel, eye, [0.3, 0.7]);
//! #           let _ = (rgb, next);
//!         }
//!     }
//!     other => println!("a {}: expand it first", other.family()),
//! }
//! # Ok(()) }
//! # assert!(show(b"not a file").is_err());
//! ```
//!
//! The feature `alloc` adds what allocates: [`FactoredBtf::expand`] needs buffers from its caller, `expand_in` takes them
//! from the heap. The feature `push` adds `push::PushReader`, which reads files from bytes as they come within a buffer of a fixed size, and
//! `bssrdf::ProfileTable`. The feature `transfer` adds `Transfer`, scattering precomputed for the vertices of a mesh; without it such files
//! are refused as those of a newer version.
#![no_std]
#![forbid(unsafe_code)]
#![deny(
    clippy::arithmetic_side_effects,
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic
)]

#[cfg(feature = "alloc")]
extern crate alloc;

pub mod bssrdf;
pub mod btf;
pub mod container;
mod decimal;
mod detect;
mod error;
mod family;
mod file;
pub mod kernel;
mod powers;
#[cfg(feature = "push")]
pub mod push;
mod section;
#[cfg(feature = "transfer")]
pub mod transfer;

pub use bssrdf::Bssrdf;
pub use btf::{Evaluate, FactoredBtf, NestedBtf};
pub use error::ReadError;
pub use family::Family;
pub use file::{Content, File};
pub use kernel::Kernel;
#[cfg(feature = "push")]
pub use push::PushReader;
pub use section::Section;
#[cfg(feature = "transfer")]
pub use transfer::Transfer;
