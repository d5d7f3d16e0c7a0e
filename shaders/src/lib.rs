//! The shaders that draw `.subsurf` materials, the uniform blocks they share with Rust, and their twins on the CPU.
//!
//! - [`passes`]: the table of all passes. WGSL files are joined, not preprocessed: a pass is a file under `wgsl/pass/` after
//!   the parts that its first line names, files under `wgsl/lib/` and `wgsl/material/`.
//! - [`uniform`]: uniform blocks, laid out as in WGSL.
//! - [`separable`]: what the separable passes draw, the basis of a material, with the coefficients of every pixel for the CPU.
//! - [`cpu`] (the gathers, on all cores, with the feature `gather`; of files of transfer, with the feature `transfer`): a pass `wgsl/pass/…/NAME.wgsl` has a twin `cpu/NAME.rs` that gives the same numbers, but for these:
//!
//! * `blur_patch_first`, `blur_patch`, `sum_patch`, `blur_patch_last`: stages of one sum, which
//!   [`separable::ProjectedBasis::exitance`] computes as a whole.
//! * `homogeneous`, `copy`, `shade_coat`: baselines that are timed, not looked at.
//! * `btf_query`: its twin is the decoder.
//! * `tsm_render`, `tsm_reduce`, `surface_gbuffer`, `splat`, `splat_resolve`, `shade_splat`: they approximate what
//!   [`cpu::surface_gather`] computes exactly, from what lights and the camera see; their pictures are held to its pictures.
//! * `separable_gbuffer`, `blur_screen`, `sum_screen`, `blur_screen_last`, `shade_separable`, `fill_volume`, `blur_volume`, `sum_volume`:
//!   likewise.
//! * `linsss_gbuffer`, `linsss_blur`, `linsss_reduce`, `linsss_lookup`, `shade_linsss`: a rival, compared with those pictures.

pub mod cpu;
mod mean_kernel;
pub mod passes;
mod rgb;
pub mod separable;
#[cfg(feature = "transfer")]
mod transfer;
pub mod uniform;

pub use mean_kernel::{mean_kernel, softening_gain};
pub use passes::{BtfLayout, MaterialLayout, TargetFormat};
pub use rgb::Rgb;
#[cfg(feature = "transfer")]
pub use transfer::{TransferLight, transfer_tint};
