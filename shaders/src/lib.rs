//! The shaders that draw `.subsurf` materials, the uniforms they share with Rust, and a CPU twin of every pass.
//!
//! WGSL files are joined, not preprocessed: a pass is the constants of [`source`] that it needs, one after the other.
//! Each pass `wgsl/NAME.wgsl` that computes something has a twin `cpu/NAME.rs` which gives the same numbers.

pub mod cpu;
pub mod separable;
pub mod source;
pub mod uniform;

pub use source::{BtfStorage, Storage};
