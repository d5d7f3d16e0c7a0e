//! Sizes for a quality or for a number of bytes: a walk along the rate-distortion curve.

use crate::capture::Images;
use crate::error::{Error, Result};
use crate::metrics::btf::{BtfError, compare, mean, with_file};
use crate::progress::Progress;

/// What a file has to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// At least this mean structural similarity of Y, Cr and Cb, with as few bytes as possible.
    Ssim(f64),
    /// At most this many bytes, with the highest similarity.
    Bytes(u64),
}

/// Sizes along which files grow.
pub trait Rung: Clone {
    /// What it is called in tables.
    fn name(&self) -> String;
    /// What lies between it and a larger one, `part` of the way, 0 to 1; none if there is nothing, or no one way.
    fn between(&self, next: &Self, part: f64) -> Option<Self>;
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
    /// By their bytes.
    pub points: Vec<Point>,
    /// Number of the best.
    pub best: usize,
}

/// Every so many pairs are compared; prime, and thus of all lights and views.
pub const PAIR_STEP: usize = 61;
/// Files between two rungs that are tried.
const BETWEEN: usize = 3;
/// A file that takes this much of the bytes it may is large enough.
const ENOUGH: f64 = 0.97;

/// Encodes one rung of `ladder` after the other, smaller files first, until the target is reached, or all that are small
/// enough; then a few between the last that stayed below the target and the next; hands each point to `said` as it comes.
///
/// # Errors
/// As `encode`; [`Error::Request`] if not even the first rungs are small enough, or images are smaller than the window of
/// structural similarity.
pub fn walk<R: Rung>(
    materials: &[Images],
    ladder: &[R],
    target: Target,
    progress: &impl Progress,
    encode: impl Fn(&R) -> Result<Vec<u8>>,
    said: impl FnMut(&Point),
) -> Result<Walked> {
    let mut walk = Walk { materials, target, progress, encode, said, points: Vec::new() };
    // Bytes of rungs that are too large.
    let mut too_large: Vec<(R, usize)> = Vec::new();
    for rung in ladder {
        // What is larger still is too large as well.
        if too_large.iter().any(|(smaller, _)| smaller.between(rung, 0.5).is_some()) {
            continue;
        }
        let tried = walk.look(rung)?;
        if !tried.fits {
            too_large.push((rung.clone(), tried.bytes));
        }
        if walk.reaches(tried.quality) || progress.stopped() {
            break;
        }
    }
    let Some(best) = walk.best() else {
        let least = too_large.into_iter().map(|(_, bytes)| bytes).min().unwrap_or(0);
        return Err(Error::Request(format!("no file is that small; the least takes {least} bytes")));
    };
    match target {
        Target::Bytes(limit) => walk.fill(limit, best, &too_large)?,
        Target::Ssim(least) => walk.shrink(least, best)?,
    }
    walk.points.sort_by_key(|(_, point)| point.bytes.len());
    let best = walk.best().unwrap_or(0);
    Ok(Walked { points: walk.points.into_iter().map(|(_, point)| point).collect(), best })
}

/// What came of a rung.
struct Tried {
    bytes: usize,
    /// If it is a point: it is not too large.
    fits: bool,
    /// Mean structural similarity of a point, else 0.
    quality: f64,
}

/// A walk under way.
struct Walk<'a, R, P, E, S> {
    materials: &'a [Images],
    target: Target,
    progress: &'a P,
    encode: E,
    said: S,
    /// With their rungs, as they came.
    points: Vec<(R, Point)>,
}

impl<R: Rung, P: Progress, E: Fn(&R) -> Result<Vec<u8>>, S: FnMut(&Point)> Walk<'_, R, P, E, S> {
    /// Encodes; adds a point if the file is not too large.
    fn look(&mut self, rung: &R) -> Result<Tried> {
        let bytes = (self.encode)(rung)?;
        let len = bytes.len();
        if matches!(self.target, Target::Bytes(limit) if len as u64 > limit) {
            return Ok(Tried { bytes: len, fits: false, quality: 0.0 });
        }
        let error = judge(self.materials, &bytes, self.progress);
        if error.mssim.is_none() {
            let what = "structural similarity needs images of 11 × 11 pixels at least; give sizes yourself";
            return Err(Error::Request(what.to_owned()));
        }
        let point = Point { name: rung.name(), bytes, error };
        (self.said)(&point);
        let quality = quality(&point);
        self.points.push((rung.clone(), point));
        Ok(Tried { bytes: len, fits: true, quality })
    }

    fn reaches(&self, quality: f64) -> bool {
        matches!(self.target, Target::Ssim(least) if quality >= least)
    }

    /// The smallest that reaches a quality, or else the best of all.
    fn best(&self) -> Option<usize> {
        let all = || 0..self.points.len();
        let quality = |number: &usize| quality(&self.points[*number].1);
        let bytes = |number: &usize| self.points[*number].1.bytes.len();
        let smallest = all().filter(|number| self.reaches(quality(number))).min_by_key(bytes);
        smallest.or_else(|| all().max_by(|a, b| quality(a).total_cmp(&quality(b))))
    }

    /// Tries files of as many bytes as there may be, from the best to the first that is too large.
    fn fill(&mut self, limit: u64, best: usize, too_large: &[(R, usize)]) -> Result<()> {
        let (low, point) = &self.points[best];
        let (mut low, mut low_bytes) = (low.clone(), point.bytes.len() as f64);
        let Some((mut high, high_bytes)) = too_large.iter().find(|(rung, _)| low.between(rung, 0.5).is_some()).cloned()
        else {
            return Ok(());
        };
        let (limit, mut high_bytes) = (limit as f64, high_bytes as f64);
        for _ in 0..BETWEEN {
            let wanted = 0.5 * (1.0 + ENOUGH) * limit;
            let part = (wanted - low_bytes) / (high_bytes - low_bytes);
            let rung = if low_bytes < ENOUGH * limit { low.between(&high, part) } else { None };
            let Some(rung) = rung.filter(|_| !self.progress.stopped()) else { break };
            let tried = self.look(&rung)?;
            if tried.fits {
                (low, low_bytes) = (rung, tried.bytes as f64);
            } else {
                (high, high_bytes) = (rung, tried.bytes as f64);
            }
        }
        Ok(())
    }

    /// Tries smaller files of the quality, from the last below it to the best.
    fn shrink(&mut self, least: f64, best: usize) -> Result<()> {
        let of = |(rung, point): &(R, Point)| (rung.clone(), quality(point));
        let (mut high, mut high_quality) = of(&self.points[best]);
        let below = self.points[..best].iter().rev().find(|(rung, _)| rung.between(&high, 0.5).is_some());
        let Some((mut low, mut low_quality)) = below.map(of) else { return Ok(()) };
        for _ in 0..BETWEEN {
            // A little more than should do.
            let part = 0.1 + 0.9 * (least - low_quality) / (high_quality - low_quality);
            let rung = if high_quality >= least { low.between(&high, part) } else { None };
            let Some(rung) = rung.filter(|_| !self.progress.stopped()) else { break };
            let found = self.look(&rung)?.quality;
            if found >= least {
                (high, high_quality) = (rung, found);
            } else {
                (low, low_quality) = (rung, found);
            }
        }
        Ok(())
    }
}

/// Mean structural similarity; every point has one.
fn quality(point: &Point) -> f64 {
    point.error.mean_mssim().unwrap_or(0.0)
}

/// The mean error of all materials over a sample of pairs.
///
/// # Panics
/// If the decoder refuses the file.
pub fn judge(materials: &[Images], bytes: &[u8], progress: &impl Progress) -> BtfError {
    let errors = with_file(bytes, |file| -> Vec<BtfError> {
        let of = |(number, images): (usize, &Images)| {
            let pairs: Vec<usize> = (0..images.pairs()).step_by(PAIR_STEP).collect();
            compare(images, file, number, &pairs, progress)
        };
        materials.iter().enumerate().map(of).collect()
    });
    let errors = errors.expect("the decoder reads what was just written");
    let count = errors.len() as f64;
    BtfError {
        mssim: mean(errors.iter().map(|error| error.mssim)),
        psnr_db: errors.iter().map(|error| error.psnr_db).sum::<f64>() / count,
        pairs: errors.iter().map(|error| error.pairs).sum(),
    }
}
