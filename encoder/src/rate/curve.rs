//! Points of the rate-distortion curve, and what is looked for on it.

/// What a file has to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// At least this quality with as few bytes as possible, see [`Distortion::quality`].
    Quality(f64),
    /// At most this many bytes with the highest quality.
    Bytes(u64),
}

impl Target {
    /// Whether a file of this quality is good enough; none is where bytes are asked for.
    pub(super) fn is_reached(self, quality: f64) -> bool {
        matches!(self, Self::Quality(least) if quality >= least)
    }

    /// Whether a file of so many bytes is small enough.
    pub(super) fn fits(self, bytes: usize) -> bool {
        !matches!(self, Self::Bytes(limit) if bytes as u64 > limit)
    }
}

/// How far a file is from what was measured.
pub trait Distortion {
    /// The number that [`Target::Quality`] is about, larger for better files: PSNR under uniform light in dB of a
    /// BSSRDF, mean structural similarity of Y, Cr and Cb (0 to 1) of a BTF, minus e_rms of a transfer; −∞ or 0 where there is none.
    fn quality(&self) -> f64;
}

/// Request to an encoder that has larger and smaller neighbours.
pub trait Candidate: Clone {
    /// The candidate between this one and a larger one, `part` of the way, 0 to 1; `None` if there is none, or if the
    /// two differ in more than size.
    fn between(&self, next: &Self, part: f64) -> Option<Self>;
}

/// One file that was tried.
#[derive(Clone, Debug)]
pub struct RdPoint<C, F, D> {
    /// What was asked of the encoder.
    pub candidate: C,
    /// The file.
    pub file: F,
    /// How far it is from what was measured.
    pub distortion: D,
}

impl<C, F: AsRef<[u8]>, D: Distortion> RdPoint<C, F, D> {
    /// Bytes of the file.
    pub fn bytes(&self) -> usize {
        self.file.as_ref().len()
    }

    /// [`Distortion::quality`] of the file.
    pub fn quality(&self) -> f64 {
        self.distortion.quality()
    }
}

/// Files that were tried, and the one to take.
#[derive(Clone, Debug)]
pub struct RdCurve<C, F, D> {
    /// Files that were tried; in which order says each family's search.
    pub points: Vec<RdPoint<C, F, D>>,
    /// Number of the best one in [`Self::points`].
    pub best: usize,
    /// Whether [`Progress::stopped`](crate::Progress::stopped) cut the search short; the best one may then miss a quality.
    pub stopped: bool,
}

impl<C, F, D> RdCurve<C, F, D> {
    /// The point to take.
    pub fn chosen(&self) -> &RdPoint<C, F, D> {
        &self.points[self.best]
    }
}

/// Number of the smallest point that reaches the target, or else of the best of all; `None` if there is no point.
pub(super) fn best<C, F: AsRef<[u8]>, D: Distortion>(points: &[RdPoint<C, F, D>], target: Target) -> Option<usize> {
    let all = || 0..points.len();
    let smallest =
        all().filter(|k| target.is_reached(points[*k].quality())).min_by_key(|number| points[*number].bytes());
    smallest.or_else(|| all().max_by(|a, b| points[*a].quality().total_cmp(&points[*b].quality())))
}
