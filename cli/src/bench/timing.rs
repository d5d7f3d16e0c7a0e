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
    let of = |step: fn(&Steps) -> f64| median(runs.iter().map(step).collect());
    Steps {
        read: of(|run| run.read),
        parse: of(|run| run.parse),
        upload: of(|run| run.upload),
        first_frame: of(|run| run.first_frame),
        total: of(|run| run.total),
    }
}

/// The middle value; 0 of none.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[n / 2],
        n => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
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
