//! The one judge: errors of files against what was measured.
//!
//! Albedo error, PSNR and SSIM of BSSRDFs ([`bssrdf`]); PSNR and mean SSIM (MSSIM) of BTFs ([`btf`]); errors of separable kernels ([`kernel`])
//! and of transfer, with images of the mesh ([`transfer`]).

pub mod bssrdf;
pub mod btf;
mod image;
pub mod kernel;
pub mod transfer;

pub use image::{psnr_db, ssim};
