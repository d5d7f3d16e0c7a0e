//! Climbing a ladder from its small end, where sizes are only known once a file is there.

use super::curve::{Candidate, Target};
use super::search::{Codec, Search};
use crate::error::Result;

/// Files between two candidates of a ladder that are tried.
const BETWEEN: usize = 3;
/// Share of the bytes that a file may take at which it is large enough.
const ENOUGH: f64 = 0.97;

impl<K: Codec<Candidate: Candidate>> Search<'_, K> {
    /// Tries one candidate after the other, smaller files first, until the target is reached, or all that are small
    /// enough; then a few between the last that stayed below the target and the next. Says how many bytes the smallest
    /// file has that was too large, if no file was small enough.
    pub(super) fn climb(&mut self, ladder: &[K::Candidate]) -> Result<std::result::Result<(), usize>> {
        let mut too_large: Vec<(K::Candidate, usize)> = Vec::new();
        for candidate in ladder {
            // What is larger still is too large as well.
            if too_large.iter().any(|(smaller, _)| smaller.between(candidate, 0.5).is_some()) {
                continue;
            }
            let trial = self.try_out(candidate)?;
            if trial.quality.is_none() {
                too_large.push((candidate.clone(), trial.bytes));
            }
            if self.target.is_reached(trial.quality.unwrap_or(0.0)) || self.progress.stopped() {
                break;
            }
        }
        let Some(best) = self.best() else {
            return Ok(Err(too_large.into_iter().map(|(_, bytes)| bytes).min().unwrap_or(0)));
        };
        match self.target {
            Target::Bytes(limit) => self.fill(limit, best, &too_large)?,
            Target::Quality(least) => self.shrink(least, best)?,
        }
        Ok(Ok(()))
    }

    /// Tries files of as many bytes as there may be, from the best to the first that is too large.
    fn fill(&mut self, limit: u64, best: usize, too_large: &[(K::Candidate, usize)]) -> Result<()> {
        let point = &self.points[best];
        let (mut low, mut low_bytes) = (point.candidate.clone(), point.bytes() as f64);
        let above = too_large.iter().find(|(candidate, _)| low.between(candidate, 0.5).is_some());
        let Some((mut high, high_bytes)) = above.cloned() else {
            return Ok(());
        };
        let (limit, mut high_bytes) = (limit as f64, high_bytes as f64);
        for _ in 0..BETWEEN {
            let wanted = 0.5 * (1.0 + ENOUGH) * limit;
            let part = (wanted - low_bytes) / (high_bytes - low_bytes);
            let next = if low_bytes < ENOUGH * limit { low.between(&high, part) } else { None };
            let Some(next) = next.filter(|_| !self.progress.stopped()) else { break };
            let trial = self.try_out(&next)?;
            if trial.quality.is_some() {
                (low, low_bytes) = (next, trial.bytes as f64);
            } else {
                (high, high_bytes) = (next, trial.bytes as f64);
            }
        }
        Ok(())
    }

    /// Tries smaller files of the quality, from the last below it to the best.
    fn shrink(&mut self, least: f64, best: usize) -> Result<()> {
        let of = |number: usize, search: &Self| {
            let point = &search.points[number];
            (point.candidate.clone(), point.quality())
        };
        let (mut high, mut high_quality) = of(best, self);
        let below = (0..best).rev().find(|number| self.points[*number].candidate.between(&high, 0.5).is_some());
        let Some((mut low, mut low_quality)) = below.map(|number| of(number, self)) else { return Ok(()) };
        for _ in 0..BETWEEN {
            // A little more than should do.
            let part = 0.1 + 0.9 * (least - low_quality) / (high_quality - low_quality);
            let next = if high_quality >= least { low.between(&high, part) } else { None };
            let Some(next) = next.filter(|_| !self.progress.stopped()) else { break };
            let found = self.try_out(&next)?.quality.unwrap_or(0.0);
            if found >= least {
                (high, high_quality) = (next, found);
            } else {
                (low, low_quality) = (next, found);
            }
        }
        Ok(())
    }
}
