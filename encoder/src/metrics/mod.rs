//! How far a fitted material is from its capture.

pub mod btf;
mod image;
mod relight;

pub use image::{psnr_db, ssim};
pub use relight::{Comparison, Light, Relit, compare};
