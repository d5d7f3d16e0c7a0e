//! BTF files along the rate-distortion curve.

use super::curve::{Candidate, Distortion, RdCurve, RdPoint, Target};
use super::search::{Codec, Search};
use crate::capture::Images;
use crate::error::{Error, Result};
use crate::metrics::btf::{BtfError, judge};
use crate::progress::Progress;

/// A BTF file that was tried.
pub type Point<C> = RdPoint<C, Vec<u8>, BtfError>;
/// BTF files that were tried, by their bytes.
pub type Curve<C> = RdCurve<C, Vec<u8>, BtfError>;

/// Mean structural similarity of Y, Cr and Cb, 0 to 1.
impl Distortion for BtfError {
    fn quality(&self) -> f64 {
        self.mean_mssim().unwrap_or(0.0)
    }
}

/// The best file of some materials for a target, from the candidates of a ladder, whose files grow, and from what lies
/// between them; every file that is small enough is shown to `found` as it comes.
///
/// Files are judged by every 61st pair of directions ([`PAIR_STEP`](crate::metrics::btf::PAIR_STEP)). If no candidate
/// reaches a quality, the best one is taken.
///
/// # Errors
/// As `encode`; [`Error::OwnOutput`] if the decoder refuses what it made; [`Error::Request`] if not even the first
/// candidates are small enough, or if images are smaller than the window of structural similarity.
pub fn search<C: Candidate>(
    materials: &[Images],
    ladder: &[C],
    target: Target,
    progress: &dyn Progress,
    encode: impl Fn(&C) -> Result<Vec<u8>>,
    found: &mut dyn FnMut(&Point<C>),
) -> Result<Curve<C>> {
    let codec = Files { materials, encode, progress, candidate: std::marker::PhantomData };
    let mut search = Search::new(codec, target, progress, found);
    if let Err(least) = search.climb(ladder)? {
        return Err(Error::Request(format!("no file is that small; the least takes {least} bytes")));
    }
    search.points.sort_by_key(Point::bytes);
    Ok(search.finish().expect("a file was small enough"))
}

/// Files of some materials, judged by their images.
struct Files<'a, C, E> {
    materials: &'a [Images],
    encode: E,
    progress: &'a dyn Progress,
    candidate: std::marker::PhantomData<C>,
}

impl<C: Candidate, E: Fn(&C) -> Result<Vec<u8>>> Codec for Files<'_, C, E> {
    type Candidate = C;
    type File = Vec<u8>;
    type Distortion = BtfError;

    fn encode(&mut self, candidate: &C) -> Result<Vec<u8>> {
        (self.encode)(candidate)
    }

    fn judge(&self, bytes: &Vec<u8>) -> Result<BtfError> {
        let error = judge(self.materials, bytes, self.progress).map_err(|source| Error::OwnOutput { source })?;
        if error.mssim.is_none() {
            let what = "structural similarity needs images of 11 × 11 pixels at least; give sizes yourself";
            return Err(Error::Request(what.to_owned()));
        }
        Ok(error)
    }
}
