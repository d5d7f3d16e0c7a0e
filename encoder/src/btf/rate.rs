//! Sizes for a quality or for a number of bytes: a walk along the rate-distortion curve.

use super::Images;
use crate::error::{Error, Result};
use crate::metrics::btf::{BtfError, compare, with_file};
use crate::progress::Progress;

/// What a file has to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// At least this mean structural similarity of Y, Cr and Cb, with as few bytes as possible.
    Ssim(f64),
    /// At most this many bytes, with the highest similarity.
    Bytes(u64),
}

/// One file that was tried.
#[derive(Clone, Debug)]
pub struct Point {
    /// What was asked of the encoder.
    pub name: String,
    /// The file.
    pub bytes: Vec<u8>,
    /// How far it is from the images, over a sample of pairs; the mean over materials.
    pub error: BtfError,
}

/// Files that were tried, by size, and the one to take.
#[derive(Clone, Debug)]
pub struct Walked {
    /// In the order of the ladder.
    pub points: Vec<Point>,
    /// Number of the best.
    pub best: usize,
}

/// Every so many pairs are compared; prime, and thus of all lights and views.
pub const PAIR_STEP: usize = 61;

/// Encodes one rung of `ladder` after the other, smaller files first, until the target is reached, or all that are small
/// enough; hands each point to `said` as it comes.
///
/// # Errors
/// As `encode`; [`Error::Request`] if not even the first rungs are small enough, or images are smaller than the window of
/// structural similarity.
pub fn walk<S>(
    materials: &[Images],
    ladder: &[(String, S)],
    target: Target,
    progress: &impl Progress,
    encode: impl Fn(&S) -> Result<Vec<u8>>,
    mut said: impl FnMut(&Point),
) -> Result<Walked> {
    let mut points: Vec<Point> = Vec::new();
    let mut too_large = Vec::new();
    for (name, sizes) in ladder {
        let bytes = encode(sizes)?;
        if let Target::Bytes(limit) = target
            && bytes.len() as u64 > limit
        {
            too_large.push(bytes.len());
            // Bytes grow along the ladder, but now and then a rung is smaller than the one before.
            if too_large.len() == 2 {
                break;
            }
            continue;
        }
        let error = judge(materials, &bytes, progress)?;
        let point = Point { name: name.clone(), bytes, error };
        said(&point);
        points.push(point);
        let reached = matches!(target, Target::Ssim(least) if error.mean_mssim() >= least);
        if reached || progress.stopped() {
            break;
        }
    }
    let quality = |number: &usize| points[*number].error.mean_mssim();
    let highest = (0..points.len()).max_by(|a, b| quality(a).total_cmp(&quality(b)));
    let best = match target {
        Target::Bytes(_) => highest,
        Target::Ssim(least) => (0..points.len()).find(|number| quality(number) >= least).or(highest),
    };
    match best {
        Some(best) => Ok(Walked { points, best }),
        None => {
            let least = too_large.into_iter().min().unwrap_or(0);
            Err(Error::Request(format!("no file is that small; the least takes {least} bytes")))
        }
    }
}

/// The mean error of all materials over a sample of pairs.
///
/// # Errors
/// [`Error::Request`] if images are smaller than the window of structural similarity.
///
/// # Panics
/// If the decoder refuses the file.
pub fn judge(materials: &[Images], bytes: &[u8], progress: &impl Progress) -> Result<BtfError> {
    let mut sum = BtfError { mssim: [0.0; 3], psnr_db: 0.0, pairs: 0 };
    for (number, images) in materials.iter().enumerate() {
        let pairs: Vec<usize> = (0..images.pairs()).step_by(PAIR_STEP).collect();
        let error = with_file(bytes, |file| compare(images, file, number, &pairs, progress))
            .expect("the decoder reads what was just written");
        let error = error.ok_or_else(|| {
            Error::Request(format!("{}: images are smaller than 11 × 11 pixels; give sizes yourself", images.label()))
        })?;
        let share = 1.0 / materials.len() as f64;
        for c in 0..3 {
            sum.mssim[c] += share * error.mssim[c];
        }
        sum.psnr_db += share * error.psnr_db;
        sum.pairs += error.pairs;
    }
    Ok(sum)
}
