//! What is reported of a BSSRDF file: its errors, and the bytes on both sides.

use subsurf_decoder::Bssrdf;

use super::comparison::{Comparison, compare};
use crate::capture::Capture;
use crate::error::Result;
use crate::progress::Progress;

/// Numbers of a comparison, and what they come from.
pub struct Judgement {
    /// Albedo and pictures, from the capture and from the file.
    pub comparison: Comparison,
    /// Mean relative error of the diffuse albedo.
    pub relative_error_mean: f64,
    /// PSNR in dB under each of [`Light::ALL`](super::Light::ALL); `None` where the light meets nothing that was measured.
    pub psnr_db: [Option<f64>; 3],
    /// SSIM of the same pictures; `None` there, too, and for patches smaller than its window.
    pub ssim: [Option<f64>; 3],
    /// Bytes of the file.
    pub bytes: u64,
    /// Bytes of the capture.
    pub capture_bytes: u64,
}

/// Judgement of a file of so many bytes, on all measured pairs.
///
/// # Errors
/// As [`compare`].
pub fn judge(capture: &Capture, material: &Bssrdf<'_>, bytes: u64, progress: &dyn Progress) -> Result<Judgement> {
    let comparison = compare(capture, material, progress)?;
    Ok(Judgement {
        relative_error_mean: comparison.albedo.mean_relative_error(),
        psnr_db: comparison.psnr_db(),
        ssim: comparison.ssim(capture.width()),
        bytes,
        capture_bytes: capture.file_bytes(),
        comparison,
    })
}
