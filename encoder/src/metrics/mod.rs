//! How far a fitted material is from its capture.

pub mod bssrdf;
pub mod btf;
mod image;

pub use image::{psnr_db, ssim};
