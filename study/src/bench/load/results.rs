//! Times of loading one material, step by step.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Microseconds of the steps from a file to a picture; medians once several runs are taken together.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(crate) struct Steps {
    /// From the file into memory.
    pub(crate) read: f64,
    /// All checks, CRCs included.
    pub(crate) parse: f64,
    /// Onto the device, until it has everything.
    pub(crate) upload: f64,
    /// Gathering 64 × 64 pixels and reading their picture back.
    pub(crate) first_frame: f64,
    /// All of these.
    pub(crate) total: f64,
}

impl Steps {
    /// Until the material can be drawn: read, parse, upload.
    pub(crate) fn load(&self) -> f64 {
        self.read + self.parse + self.upload
    }
}

/// Step-wise medians.
pub(crate) fn medians(runs: &[Steps]) -> Steps {
    let of = |step: fn(&Steps) -> f64| median(&runs.iter().map(step).collect::<Vec<_>>());
    Steps {
        read: of(|run| run.read),
        parse: of(|run| run.parse),
        upload: of(|run| run.upload),
        first_frame: of(|run| run.first_frame),
        total: of(|run| run.total),
    }
}

/// The middle value; 0 of none.
pub(crate) fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value that this share of all is not above, linear between two of them; 0 of none.
pub(crate) fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    #[allow(clippy::cast_precision_loss, reason = "small")]
    let place = share * sorted.len().saturating_sub(1) as f64;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place among them")]
    let below = place as usize;
    let at = |k: usize| sorted.get(k).or(sorted.last()).copied().unwrap_or(0.0);
    at(below) + place.fract() * (at(below + 1) - at(below))
}

/// What is known of one way to store a material.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(crate) struct Storage {
    /// Length of the file.
    pub(crate) bytes: u64,
    /// Bytes of the material on the device, by our own ledger.
    pub(crate) gpu_bytes: u64,
    /// Peak resident memory of a process that does nothing else.
    pub(crate) peak_rss_bytes: u64,
    /// Of that, what the process and its driver had before the first load.
    pub(crate) baseline_rss_bytes: u64,
    /// File in the page cache.
    pub(crate) warm_us: Steps,
    /// Page cache dropped before every read; absent where the system cannot.
    pub(crate) cold_us: Option<Steps>,
    /// Parts of `parse`, and what to compare them with.
    #[serde(flatten)]
    pub(crate) parts_us: BTreeMap<String, f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_values() {
        assert!(median(&[]).abs() < 1e-12);
        assert!((median(&[3.0]) - 3.0).abs() < 1e-12);
        assert!((median(&[4.0, 1.0, 2.0]) - 2.0).abs() < 1e-12);
        assert!((median(&[4.0, 1.0, 2.0, 3.0]) - 2.5).abs() < 1e-12);
        assert!((quantile(&[5.0, 1.0, 2.0, 3.0, 4.0], 0.95) - 4.8).abs() < 1e-12);
    }
}
