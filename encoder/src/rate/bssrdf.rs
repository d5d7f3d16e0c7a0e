//! K-BMPP files along the rate-distortion curve.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Coding;
use subsurf_decoder::bssrdf::layout::MAX_BASE_MATERIALS;

use super::curve::{Distortion, RdCurve, RdPoint, Target};
use super::search::{Codec, Search};
use crate::bssrdf::{Encoded, Options, Problem, base_materials_within, file_bytes};
use crate::capture::Capture;
use crate::error::{Error, Result};
use crate::metrics::bssrdf::{BssrdfError, compare};
use crate::progress::Progress;

/// A K-BMPP file that was tried, with its K, M and precision.
pub type Point = RdPoint<Options, Encoded, BssrdfError>;
/// K-BMPP files that were tried, in the order in which they were tried.
pub type Curve = RdCurve<Options, Encoded, BssrdfError>;

/// PSNR under uniform light in dB; −∞ where nothing is lit.
impl Distortion for BssrdfError {
    fn quality(&self) -> f64 {
        self.psnr_db[0].unwrap_or(f64::NEG_INFINITY)
    }
}

/// K, coding and whether profiles are half floats, by rising bits per pixel.
///
/// Base profiles are half floats throughout but for the last: their rounding costs less than the base materials that they
/// leave room for. Exact ratios of two base materials are left out: those in 8 bits serve as well in half the bytes.
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

/// The best K-BMPP file of a capture for a target; every file that is tried is shown to `found` as it comes.
///
/// `samples` is S, R + 1 if not given; `seed` is that of the first cluster centres.
///
/// # Errors
/// As [`Problem::new`] and [`Problem::fit`]; [`Error::Request`] if nothing reaches the target, or if it is no number.
pub fn search(
    capture: &Capture,
    samples: Option<usize>,
    seed: u64,
    target: Target,
    progress: &dyn Progress,
    found: &mut dyn FnMut(&Point),
) -> Result<Curve> {
    if matches!(target, Target::Quality(least) if !least.is_finite()) {
        return Err(Error::Request("a PSNR to reach must be a number of dB, for example 40".to_owned()));
    }
    let sizes = Sizes { capture, samples, seed };
    let codec = Fits { capture, problem: Problem::new(capture, samples, progress)?, progress };
    let mut search = Search::new(codec, target, progress, found);
    match target {
        Target::Bytes(limit) => along_size(&mut search, &sizes, limit)?,
        Target::Quality(_) => along_quality(&mut search, &sizes)?,
    }
    let curve = search.finish().expect("something was tried");
    let best = curve.chosen();
    match target {
        Target::Quality(least) if best.quality() < least && !curve.stopped => Err(Error::Request(format!(
            "no model that was tried reaches {least} dB under uniform light; the best has {:.1} dB in {} bytes",
            best.quality(),
            best.bytes(),
        ))),
        _ => Ok(curve),
    }
}

/// Options of all candidates, and the bytes of their files, which are known before they are fitted.
struct Sizes<'a> {
    capture: &'a Capture,
    samples: Option<usize>,
    seed: u64,
}

impl Sizes<'_> {
    fn options(&self, kind: (usize, Coding, bool), base_materials: usize) -> Options {
        let (per_pixel, coding, half_profiles) = kind;
        Options { per_pixel, coding, half_profiles, base_materials, seed: self.seed, ..Options::default() }
    }

    fn bytes(&self, options: &Options) -> Result<u64> {
        file_bytes(self.capture, self.samples, options)
    }
}

/// Tries of every kind the model with the most base materials that fit.
fn along_size(search: &mut Search<'_, Fits<'_>>, sizes: &Sizes<'_>, limit: u64) -> Result<()> {
    let most = MAX_BASE_MATERIALS as usize;
    let mut smallest = u64::MAX;
    for kind in KINDS {
        let one = sizes.options(kind, 1);
        smallest = smallest.min(sizes.bytes(&one)?);
        let base_materials = base_materials_within(sizes.capture, sizes.samples, &one, limit)?.min(most);
        if base_materials > 0 && (search.points.is_empty() || !search.progress.stopped()) {
            search.try_out(&sizes.options(kind, base_materials))?;
        }
    }
    if search.points.is_empty() {
        let message = format!("no model that is tried takes {limit} bytes or less; the smallest takes {smallest}");
        return Err(Error::Request(message));
    }
    Ok(())
}

/// Tries of every kind the model with the fewest base materials that reach the quality, unless it is larger than one that
/// does already.
fn along_quality(search: &mut Search<'_, Fits<'_>>, sizes: &Sizes<'_>) -> Result<()> {
    for kind in KINDS {
        let smallest = search.smallest().map_or(u64::MAX, |bytes| bytes as u64);
        let mut ladder = Vec::new();
        for base_materials in LADDER {
            let options = sizes.options(kind, base_materials);
            if sizes.bytes(&options)? >= smallest {
                break;
            }
            ladder.push(options);
        }
        if !search.bisect(&ladder)? {
            break;
        }
    }
    Ok(())
}

/// Fits to one capture, judged by it.
struct Fits<'a> {
    capture: &'a Capture,
    problem: Problem<'a>,
    progress: &'a dyn Progress,
}

impl Codec for Fits<'_> {
    type Candidate = Options;
    type File = Encoded;
    type Distortion = BssrdfError;

    fn encode(&mut self, options: &Options) -> Result<Encoded> {
        self.problem.fit(options, self.progress)
    }

    fn judge(&self, encoded: &Encoded) -> Result<BssrdfError> {
        let material = Bssrdf::parse(&encoded.bytes).map_err(|source| Error::OwnOutput { source })?;
        Ok(compare(self.capture, &material, self.progress)?.error())
    }
}
