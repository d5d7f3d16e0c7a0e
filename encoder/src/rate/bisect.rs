//! Bisection of a ladder whose larger candidates are better: the smallest one that reaches a quality.

use super::search::{Codec, Search};
use crate::error::Result;

impl<K: Codec> Search<'_, K> {
    /// Bytes of the smallest file so far that reaches the target.
    pub(super) fn smallest(&self) -> Option<usize> {
        let reached = self.points.iter().filter(|point| self.target.is_reached(point.quality()));
        reached.map(|point| point.bytes()).min()
    }

    /// Tries the largest candidate of a ladder first: if it does not reach the target, no other will. Then halves what is
    /// left. Says whether the search goes on.
    pub(super) fn bisect(&mut self, ladder: &[K::Candidate]) -> Result<bool> {
        let (mut below, mut enough) = (0, ladder.len());
        let mut next = enough.checked_sub(1);
        while let Some(step) = next {
            let reached = self.try_out(&ladder[step])?.quality.is_some_and(|quality| self.target.is_reached(quality));
            if reached {
                enough = step;
            } else {
                below = step + 1;
            }
            if self.progress.stopped() {
                return Ok(false);
            }
            next = (below < enough).then_some(below.midpoint(enough));
        }
        Ok(true)
    }
}
