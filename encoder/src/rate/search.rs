//! The search itself: candidates are encoded, judged and remembered.

use super::curve::{Distortion, RdCurve, RdPoint, Target, best};
use crate::error::Result;
use crate::progress::Progress;

/// An encoder of one family with what its files are judged by.
pub(super) trait Codec {
    /// Type of requests to the encoder.
    type Candidate: Clone;
    /// Type of its files.
    type File: AsRef<[u8]>;
    /// Type of their errors.
    type Distortion: Distortion;

    /// A file, read back by the decoder.
    fn encode(&mut self, candidate: &Self::Candidate) -> Result<Self::File>;

    /// How far a file is from what was measured.
    fn judge(&self, file: &Self::File) -> Result<Self::Distortion>;
}

/// Point of a codec's curve.
pub(super) type Point<K> = RdPoint<<K as Codec>::Candidate, <K as Codec>::File, <K as Codec>::Distortion>;
/// Curve of a codec.
pub(super) type Curve<K> = RdCurve<<K as Codec>::Candidate, <K as Codec>::File, <K as Codec>::Distortion>;

/// Outcome of a candidate.
pub(super) struct Trial {
    /// Bytes of its file.
    pub(super) bytes: usize,
    /// Quality, if the file is not larger than it may be; only then it is a point of the curve.
    pub(super) quality: Option<f64>,
}

/// Search under way.
pub(super) struct Search<'a, K: Codec> {
    pub(super) codec: K,
    pub(super) target: Target,
    pub(super) progress: &'a dyn Progress,
    /// Is shown every point as it comes.
    pub(super) found: &'a mut dyn FnMut(&Point<K>),
    /// In the order in which they came.
    pub(super) points: Vec<Point<K>>,
}

impl<'a, K: Codec> Search<'a, K> {
    pub(super) fn new(
        codec: K,
        target: Target,
        progress: &'a dyn Progress,
        found: &'a mut dyn FnMut(&Point<K>),
    ) -> Self {
        Self { codec, target, progress, found, points: Vec::new() }
    }

    /// Encodes; judges, shows and keeps the file unless it is larger than it may be.
    pub(super) fn try_out(&mut self, candidate: &K::Candidate) -> Result<Trial> {
        let file = self.codec.encode(candidate)?;
        let bytes = file.as_ref().len();
        if !self.target.fits(bytes) {
            return Ok(Trial { bytes, quality: None });
        }
        let distortion = self.codec.judge(&file)?;
        let point = RdPoint { candidate: candidate.clone(), file, distortion };
        (self.found)(&point);
        let quality = point.quality();
        self.points.push(point);
        Ok(Trial { bytes, quality: Some(quality) })
    }

    /// Number of the point to take so far.
    pub(super) fn best(&self) -> Option<usize> {
        best(&self.points, self.target)
    }

    /// The curve, with the best of its points; `None` if there is none.
    pub(super) fn finish(self) -> Option<Curve<K>> {
        let best = self.best()?;
        Some(RdCurve { points: self.points, best, stopped: self.progress.stopped() })
    }
}
