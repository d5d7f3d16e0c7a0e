//! Sizes of codebooks for a quality or for a number of bytes: a walk along the rate-distortion curve.

use subsurf_decoder::Btf;

use super::Images;
use super::nested::{Prepared, Sizes};
use crate::error::{Error, Result};
use crate::metrics::btf::{BtfError, compare};
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
    /// Of its codebooks.
    pub stages: Vec<Sizes>,
    /// The file.
    pub bytes: Vec<u8>,
    /// How far it is from the images, over a sample of pairs; the mean over materials.
    pub error: BtfError,
}

/// Files that were tried, by size, and the one to take.
#[derive(Clone, Debug)]
pub struct Walked {
    /// Smallest codebooks first.
    pub points: Vec<Point>,
    /// Number of the best.
    pub best: usize,
}

/// Entries of P4 and stages, by the bytes they take. What gains more, larger codebooks or a second stage, depends on the
/// material: smooth ones take to stages.
const LADDER: [(usize, usize); 12] = [
    (64, 1),
    (128, 1),
    (128, 2),
    (256, 1),
    (256, 2),
    (512, 1),
    (512, 2),
    (1024, 1),
    (1024, 2),
    (2048, 1),
    (2048, 2),
    (4096, 1),
];
/// Every so many pairs are compared; prime, and thus of all lights and views.
pub const PAIR_STEP: usize = 61;

/// The codebooks of a number of stages, by the entries of P4.
#[must_use]
pub fn stages(p4: usize, count: usize) -> Vec<Sizes> {
    vec![Sizes { p4, p3: 2 * p4, p2: 2 * p4, p1: (2 * p4).min(512) }; count]
}

/// Tries codebooks until the target is reached, or all that are small enough; hands each point to `said` as it comes.
///
/// # Errors
/// As [`Prepared::encode`]; [`Error::Request`] if not even the smallest codebooks are small enough, or images are smaller
/// than the window of structural similarity.
pub fn walk(
    materials: &[Images],
    prepared: &Prepared<'_>,
    target: Target,
    progress: &impl Progress,
    mut said: impl FnMut(&Point),
) -> Result<Walked> {
    let mut points: Vec<Point> = Vec::new();
    let mut too_large = Vec::new();
    for (p4, count) in LADDER {
        let stages = stages(p4, count);
        let bytes = prepared.encode(&stages, progress)?.to_bytes();
        if let Target::Bytes(limit) = target
            && bytes.len() as u64 > limit
        {
            too_large.push(bytes.len());
            // Bytes grow along the ladder, but for two stages next to one.
            if too_large.len() == 2 {
                break;
            }
            continue;
        }
        let error = judge(materials, &bytes, progress)?;
        let point = Point { stages, bytes, error };
        said(&point);
        points.push(point);
        let reached = matches!(target, Target::Ssim(least) if error.mean_mssim() >= least);
        if reached || progress.stopped() {
            break;
        }
    }
    let quality = |number: &usize| points[*number].error.mean_mssim();
    let best = match target {
        Target::Bytes(_) => (0..points.len()).max_by(|a, b| quality(a).total_cmp(&quality(b))),
        Target::Ssim(least) => (0..points.len())
            .find(|number| quality(number) >= least)
            .or_else(|| (0..points.len()).max_by(|a, b| quality(a).total_cmp(&quality(b)))),
    };
    match best {
        Some(best) => Ok(Walked { points, best }),
        None => {
            let least = too_large.into_iter().min().unwrap_or(0);
            Err(Error::Request(format!("no codebooks are that small; the least take {least} bytes")))
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
    let file = Btf::parse(bytes).expect("the decoder reads what was just written");
    let mut sum = BtfError { mssim: [0.0; 3], psnr_db: 0.0, pairs: 0 };
    for (number, images) in materials.iter().enumerate() {
        let pairs: Vec<usize> = (0..images.pairs()).step_by(PAIR_STEP).collect();
        let error = compare(images, &file, number, &pairs, progress).ok_or_else(|| {
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
