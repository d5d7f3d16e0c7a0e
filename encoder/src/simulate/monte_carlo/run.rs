//! A run on all threads.

use std::sync::atomic::{AtomicU64, Ordering};

use rand::SeedableRng;
use rand_pcg::Pcg64;

use super::half_space::HalfSpace;
use super::outcome::{Outcome, Sums};
use super::packet::trace;
use super::request::Request;
use crate::error::Result;
use crate::math::parallel;
use crate::progress::Progress;

/// Packets that a thread traces at a time, at least and at most. Each has random numbers of its own, so results do not hang on
/// this; the last packets of a batch leave vector units idle.
const BATCH: std::ops::RangeInclusive<u64> = 1 << 12..=1 << 16;

impl Request {
    /// Traces the packets on all threads. Where `progress` says stop, the packets traced so far are the result, a batch for each
    /// thread at least.
    ///
    /// # Errors
    ///
    /// Those of [`Self::check`].
    pub fn run(&self, progress: &dyn Progress) -> Result<Outcome> {
        self.check()?;
        progress.begin("tracing photons", self.packets);
        let planes = self.stack.planes_mm();
        let half_space = HalfSpace::of(self);
        let threads = rayon::current_num_threads();
        let size = (self.packets / (8 * threads as u64)).clamp(*BATCH.start(), *BATCH.end());
        let next = AtomicU64::new(0);
        // Sums of integers are the same whichever thread takes a batch.
        let of_thread = |_| {
            let mut sums = Sums::new(self);
            loop {
                let first = next.fetch_add(size, Ordering::Relaxed);
                let end = (first + size).min(self.packets);
                if first >= end {
                    break;
                }
                match &half_space {
                    Some(half_space) => half_space.trace(first, end, &mut sums),
                    None => (first..end).for_each(|packet| {
                        trace(self, &planes, &mut Pcg64::seed_from_u64(self.seed_of(packet)), &mut sums);
                    }),
                }
                sums.packets += end - first;
                progress.advance(end - first);
                // After a batch: a run that is stopped at once has a result, too.
                if progress.stopped() {
                    break;
                }
            }
            sums
        };
        let sums = parallel::map(threads, of_thread).into_iter().fold(Sums::new(self), Sums::merged);
        Ok(Outcome::new(self, sums, half_space.is_some()))
    }
}
