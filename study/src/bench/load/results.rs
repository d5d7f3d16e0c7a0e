//! Results: times of loading one material, step by step, and its size.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use subsurf_viewer::Loading;

use crate::bench::timing::median;

/// Microseconds of the steps from a file to a picture; medians once several runs are taken together.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct Steps {
    /// Reading the file into memory.
    pub(super) read: f64,
    /// All checks, CRCs included.
    pub(super) parse: f64,
    /// Onto the device, until it has everything.
    pub(super) upload: f64,
    /// Gathering 64 × 64 pixels and reading their picture back.
    pub(super) first_frame: f64,
    /// Sum of all steps.
    pub(super) total: f64,
}

impl Steps {
    /// Steps of a load on a device, after so many microseconds of reading.
    pub(super) fn of(read: f64, loading: &Loading) -> Self {
        let [parse, upload, first_frame] =
            [loading.parse, loading.upload, loading.first_frame].map(|time| 1e6 * time.as_secs_f64());
        Self { read, parse, upload, first_frame, total: read + parse + upload + first_frame }
    }

    /// Until the material can be drawn: read, parse, upload.
    pub(super) fn load(&self) -> f64 {
        self.read + self.parse + self.upload
    }
}

/// Medians of runs, step by step.
pub(super) fn medians(runs: &[Steps]) -> Steps {
    let of = |step: fn(&Steps) -> f64| median(&runs.iter().map(step).collect::<Vec<_>>());
    Steps {
        read: of(|run| run.read),
        parse: of(|run| run.parse),
        upload: of(|run| run.upload),
        first_frame: of(|run| run.first_frame),
        total: of(|run| run.total),
    }
}

/// Size and times of one way to store a material.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct Storage {
    /// Length of the file.
    pub(super) bytes: u64,
    /// Bytes of the material on the device, by our own ledger.
    pub(super) gpu_bytes: u64,
    /// Peak resident memory of a process that does nothing else.
    pub(super) peak_rss_bytes: u64,
    /// Of that, what the process and its driver had before the first load.
    pub(super) baseline_rss_bytes: u64,
    /// Times with the file in the page cache.
    pub(super) warm_us: Steps,
    /// Times with the page cache dropped before every read; absent where the system cannot.
    pub(super) cold_us: Option<Steps>,
    /// Parts of `parse`, and what to compare them with.
    #[serde(flatten)]
    pub(super) parts_us: BTreeMap<String, f64>,
}
