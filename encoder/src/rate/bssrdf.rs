//! The smallest file of a quality, or the best of a size: a walk along the rate-distortion curve.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Coding;
use subsurf_decoder::bssrdf::layout::MAX_BASE_MATERIALS;

use crate::bssrdf::{Encoded, Options, Problem, base_materials_within, file_bytes};
use crate::capture::Capture;
use crate::error::{Error, Result};
use crate::metrics::bssrdf as metrics;
use crate::progress::Progress;

/// What a file has to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// At least this PSNR in dB under uniform light, with as few bytes as possible.
    PsnrDb(f64),
    /// At most this many bytes, with the highest PSNR.
    Bytes(u64),
}

/// One model that was tried.
#[derive(Clone, Debug)]
pub struct Point {
    /// K, M and precision.
    pub options: Options,
    /// The file.
    pub encoded: Encoded,
    /// Mean relative error of the diffuse albedo.
    pub relative_error: f64,
    /// PSNR in dB under each of [`metrics::Light::ALL`].
    pub psnr_db: [Option<f64>; 3],
}

impl Point {
    fn bytes(&self) -> u64 {
        self.encoded.bytes.len() as u64
    }

    fn uniform_db(&self) -> f64 {
        self.psnr_db[0].unwrap_or(f64::NEG_INFINITY)
    }
}

/// K and coding by rising bits per pixel. Base profiles are half floats throughout but for the last: their rounding costs
/// less than the base materials that they leave room for. Exact ratios of two base materials are left out: those in 8
/// bits serve as well in half the bytes.
const KINDS: [(usize, Coding, bool); 6] = [
    (1, Coding::Exact, true),
    (2, Coding::Palette, true),
    (2, Coding::SmallRatios, true),
    (3, Coding::Exact, true),
    (5, Coding::Exact, true),
    (5, Coding::Exact, false),
];

/// Numbers of base materials that are tried for a quality: steps of √2.
const LADDER: [usize; 13] = [4, 6, 8, 11, 16, 23, 32, 45, 64, 91, 128, 181, 256];

/// What was tried, and what came of it.
#[derive(Clone, Debug)]
pub struct Walked {
    /// All models, in the order in which they were tried.
    pub points: Vec<Point>,
    /// Number of the best one.
    pub best: usize,
    /// Whether [`Progress::stopped`] cut the walk short; the best one may then miss a quality.
    pub stopped: bool,
}

struct Walk<'a> {
    capture: &'a Capture,
    problem: Problem<'a>,
    samples: Option<usize>,
    seed: u64,
    progress: &'a dyn Progress,
    found: &'a mut dyn FnMut(&Point),
    points: Vec<Point>,
}

/// Tries models until it knows the best one for `target`; hands each to `found` as it comes.
///
/// # Errors
/// As [`Problem::new`], and [`Error::Request`] if nothing reaches the target or it is no number.
pub fn walk(
    capture: &Capture,
    samples: Option<usize>,
    seed: u64,
    target: Target,
    progress: &dyn Progress,
    found: &mut dyn FnMut(&Point),
) -> Result<Walked> {
    if matches!(target, Target::PsnrDb(least) if !least.is_finite()) {
        return Err(Error::Request("a PSNR to reach must be a number of dB, for example 40".to_owned()));
    }
    let problem = Problem::new(capture, samples, progress)?;
    let mut walk = Walk { capture, problem, samples, seed, progress, found, points: Vec::new() };
    match target {
        Target::Bytes(limit) => walk.along_size(limit)?,
        Target::PsnrDb(least) => walk.along_quality(least)?,
    }
    let best = walk.best(target)?;
    Ok(Walked { points: walk.points, best, stopped: progress.stopped() })
}

impl Walk<'_> {
    fn options(&self, kind: (usize, Coding, bool), base_materials: usize) -> Options {
        let (per_pixel, coding, half_profiles) = kind;
        Options { per_pixel, coding, half_profiles, base_materials, seed: self.seed, ..Options::default() }
    }

    fn bytes(&self, kind: (usize, Coding, bool), base_materials: usize) -> Result<u64> {
        file_bytes(self.capture, self.samples, &self.options(kind, base_materials))
    }

    /// Of every kind the model with the most base materials that fit.
    fn along_size(&mut self, limit: u64) -> Result<()> {
        let most = MAX_BASE_MATERIALS as usize;
        let mut smallest = u64::MAX;
        for kind in KINDS {
            smallest = smallest.min(self.bytes(kind, 1)?);
            let any = self.options(kind, 1);
            let base_materials = base_materials_within(self.capture, self.samples, &any, limit)?.min(most);
            if base_materials == 0 {
                continue;
            }
            if self.points.is_empty() || !self.progress.stopped() {
                self.try_out(self.options(kind, base_materials))?;
            }
        }
        if self.points.is_empty() {
            let message = format!("no model that is tried takes {limit} bytes or less; the smallest takes {smallest}");
            return Err(Error::Request(message));
        }
        Ok(())
    }

    /// Of every kind the model with the fewest base materials that reach the quality, unless it is larger than one that
    /// does already.
    fn along_quality(&mut self, least: f64) -> Result<()> {
        let mut smallest = u64::MAX;
        for kind in KINDS {
            let mut below = 0;
            let mut enough = 0;
            while enough < LADDER.len() && self.bytes(kind, LADDER[enough])? < smallest {
                enough += 1;
            }
            // The largest is tried first: if it does not reach the quality, no other will.
            let mut next = enough.checked_sub(1);
            while let Some(step) = next {
                let point = self.try_out(self.options(kind, LADDER[step]))?;
                if point.uniform_db() >= least {
                    smallest = smallest.min(point.bytes());
                    enough = step;
                } else {
                    below = step + 1;
                }
                if self.progress.stopped() {
                    return Ok(());
                }
                next = (below < enough).then_some(below.midpoint(enough));
            }
        }
        Ok(())
    }

    fn try_out(&mut self, options: Options) -> Result<&Point> {
        let encoded = self.problem.fit(&options, self.progress)?;
        let material =
            Bssrdf::parse(&encoded.bytes).map_err(|source| Error::Read { path: self.capture.path().into(), source })?;
        let comparison = metrics::compare(self.capture, &material, self.progress)?;
        let point = Point {
            options,
            encoded,
            relative_error: comparison.albedo.mean_relative_error(),
            psnr_db: comparison.psnr_db(),
        };
        (self.found)(&point);
        self.points.push(point);
        Ok(self.points.last().expect("just pushed"))
    }

    fn best(&self, target: Target) -> Result<usize> {
        let points = || self.points.iter().enumerate();
        let highest = points().max_by(|a, b| a.1.uniform_db().total_cmp(&b.1.uniform_db()));
        let (highest, at_best) = highest.expect("something was tried");
        let Target::PsnrDb(least) = target else {
            return Ok(highest);
        };
        let reached = points().filter(|(_, point)| point.uniform_db() >= least);
        match reached.min_by_key(|(_, point)| point.bytes()) {
            Some((smallest, _)) => Ok(smallest),
            None if self.progress.stopped() => Ok(highest),
            None => Err(Error::Request(format!(
                "no model that was tried reaches {least} dB under uniform light; the best has {:.1} dB in {} bytes",
                at_best.uniform_db(),
                at_best.bytes(),
            ))),
        }
    }
}
