//! Files of one mesh: made for a number of lights, and judged.

use subsurf_decoder::Transfer;

use super::{TransferCandidate, TransferDistortion, TransferSource};
use crate::error::{Error, Result};
use crate::metrics::transfer::{
    FileChannel, ImageError, Reference, Views, between, precompute_with_between, radial_weights,
};
use crate::progress::Progress;
use crate::rate::search::Codec;
use crate::transfer::{Precomputed, encode, fibonacci};

/// q for a number of lights.
pub(super) struct Interpolated {
    of: Precomputed,
    /// The same and that between the lights, as references have it.
    all: Precomputed,
    /// Weights of the lights for directions between them.
    weights: Vec<Vec<f32>>,
    pub(super) interpolation: ImageError,
}

/// Files of one mesh, judged by exact sums.
pub(super) struct Files<'a> {
    pub(super) source: TransferSource<'a>,
    views: Views,
    /// The last that was asked for.
    made: Option<Interpolated>,
    progress: &'a dyn Progress,
}

impl<'a> Files<'a> {
    pub(super) fn new(source: TransferSource<'a>, progress: &'a dyn Progress) -> Self {
        Self { source, views: Views::of(source.mesh), made: None, progress }
    }

    /// q for so many lights.
    pub(super) fn made(&mut self, lights: usize) -> Result<&Interpolated> {
        let TransferSource { mesh, table, options } = self.source;
        if self.made.as_ref().is_none_or(|made| made.of.light_count() != lights) {
            self.made = None;
            let directions = fibonacci(lights);
            let all = precompute_with_between(mesh, table, &directions, options, self.progress)?;
            let weights = radial_weights(&directions, &between())?;
            let interpolation = self.worst(&all, |reference, _| reference.total(reference.q(), &weights));
            let of = all.select(&(0..lights).collect::<Vec<usize>>());
            self.made = Some(Interpolated { of, all, weights, interpolation });
        }
        Ok(self.made.as_ref().expect("it was just made"))
    }

    /// The larger of the errors of all channels.
    fn worst(&self, all: &Precomputed, error: impl Fn(&Reference<'_>, usize) -> ImageError) -> ImageError {
        let of = |channel| error(&Reference::new(self.source.mesh, &self.views, all, channel), channel);
        (0..all.channels).map(of).reduce(ImageError::larger).expect("at least one channel")
    }
}

impl Codec for Files<'_> {
    type Candidate = TransferCandidate;
    type File = Vec<u8>;
    type Distortion = TransferDistortion;

    fn encode(&mut self, candidate: &TransferCandidate) -> Result<Vec<u8>> {
        let (TransferSource { mesh, table, options }, progress) = (self.source, self.progress);
        let Interpolated { of, .. } = self.made(candidate.lights)?;
        encode(mesh, table, of, options.eta, &candidate.size, progress)
    }

    fn judge(&self, file: &Vec<u8>) -> Result<TransferDistortion> {
        let Interpolated { all, weights, interpolation, .. } =
            self.made.as_ref().expect("what was encoded was made before");
        self.progress.begin("images", all.channels as u64);
        let file = &Transfer::parse(file).map_err(|source| Error::OwnOutput { source })?;
        let total = self.worst(all, |reference, channel| {
            let error = reference.total(&FileChannel { file, channel, largest: reference.largest() }, weights);
            self.progress.advance(1);
            error
        });
        Ok(TransferDistortion { total, interpolation: *interpolation })
    }
}
