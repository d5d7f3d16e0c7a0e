//! Times of the last frames, and how often a device may be lost.

use std::collections::VecDeque;
use std::time::Duration;

use web_time::Instant;

/// Number of frames that the median is of.
const FRAMES: usize = 60;

/// Times of the last frames.
#[derive(Debug, Default)]
pub(super) struct Times(VecDeque<Duration>);

impl Times {
    pub(super) fn enter(&mut self, time: Duration) {
        if self.0.len() == FRAMES {
            self.0.pop_front();
        }
        self.0.push_back(time);
    }

    /// Milliseconds that half of them took at most, and how many there are.
    pub(super) fn median_ms(&self) -> Option<(f64, usize)> {
        let mut sorted: Vec<_> = self.0.iter().copied().collect();
        sorted.sort();
        sorted.get(sorted.len() / 2).map(|time| (1e3 * time.as_secs_f64(), sorted.len()))
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }
}

/// Patience with a device: one that is lost again and again is not opened again and again.
#[derive(Debug, Default)]
pub(super) struct Patience(VecDeque<Instant>);

impl Patience {
    const LOSSES: usize = 3;
    const WITHIN: Duration = Duration::from_secs(30);

    /// Enters a loss; whether the device is to be opened once more.
    pub(super) fn lasts(&mut self, now: Instant) -> bool {
        self.0.retain(|then| now.duration_since(*then) < Self::WITHIN);
        self.0.push_back(now);
        self.0.len() <= Self::LOSSES
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_of_the_last_sixty() {
        let mut times = Times::default();
        assert_eq!(times.median_ms(), None);
        for ms in (0..100).chain([1000; 61]) {
            times.enter(Duration::from_millis(ms));
        }
        assert_eq!(times.median_ms(), Some((1000.0, 60)));
        times.enter(Duration::from_millis(1));
        assert_eq!(times.median_ms(), Some((1000.0, 60)), "one fast frame is no news");
    }

    #[test]
    fn patience_ends_with_the_fourth_loss_in_half_a_minute() {
        let mut patience = Patience::default();
        let start = Instant::now();
        let at = |seconds| start + Duration::from_secs(seconds);
        assert!([0, 1, 2].into_iter().all(|seconds| patience.lasts(at(seconds))), "three are forgiven");
        assert!(!patience.lasts(at(3)), "the fourth is not");
        assert!(patience.lasts(at(100)), "long ago is forgotten");
    }
}
