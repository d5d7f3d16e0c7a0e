//! Results: times of loading one material, step by step, and its size.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use subsurf_runtime::{LoadTimer, LoadTimes};

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
    /// What is computed of a file once it is there, until the device is done: coefficients and albedo, or weights between lights.
    pub(super) projection: f64,
    /// Of that, until they were recorded and submitted.
    pub(super) recording: f64,
    /// Drawing 64 × 64 pixels, until they are there.
    pub(super) first_frame: f64,
    /// Sum of all steps; pipelines are compiled before.
    pub(super) total: f64,
}

/// A step: what tables call it, and its time.
pub(super) type Step = (&'static str, fn(&Steps) -> f64);

impl Steps {
    /// Steps of materials of which nothing is projected, and all of them together.
    pub(super) const UNPROJECTED: [Step; 5] = [
        ("read", |steps| steps.read),
        ("parse", |steps| steps.parse),
        ("upload", |steps| steps.upload),
        ("first frame", |steps| steps.first_frame),
        ("total", |steps| steps.total),
    ];

    /// Loads a file on a device after so many microseconds of reading: its steps, microseconds of pipelines that were compiled before
    /// it or in it, the material's bytes on the device.
    pub(super) fn timed(timer: &LoadTimer<'_>, bytes: &[u8], read: f64) -> anyhow::Result<(Self, f64, u64)> {
        let times = timer.load(bytes)?;
        let pipelines = 1e6 * (timer.compiled() + times.pipelines).as_secs_f64();
        Ok((Self::of(read, &times), pipelines, times.gpu_bytes))
    }

    /// Steps of a load on a device, after so many microseconds of reading.
    pub(super) fn of(read: f64, times: &LoadTimes) -> Self {
        let LoadTimes { parse, upload, projection, recording, first_frame, .. } = *times;
        let [parse, upload, projection, recording, first_frame] =
            [parse, upload, projection, recording, first_frame].map(|time| 1e6 * time.as_secs_f64());
        let total = read + parse + upload + projection + first_frame;
        Self { read, parse, upload, projection, recording, first_frame, total }
    }

    /// Steps of a picture that the CPU draws.
    pub(super) fn by_cpu(read: f64, parse: f64, first_frame: f64) -> Self {
        Self { read, parse, first_frame, total: read + parse + first_frame, ..Self::default() }
    }

    /// Until the material can be drawn: read, parse, upload, projection.
    pub(super) fn load(&self) -> f64 {
        self.read + self.parse + self.upload + self.projection
    }

    /// Work of the CPU from bytes to what can be drawn: parse, upload, recording the projection.
    pub(super) fn cpu(&self) -> f64 {
        self.parse + self.upload + self.recording
    }
}

/// Medians of runs, step by step.
pub(super) fn medians(runs: &[Steps]) -> Steps {
    let of = |step: fn(&Steps) -> f64| median(&runs.iter().map(step).collect::<Vec<_>>());
    Steps {
        read: of(|run| run.read),
        parse: of(|run| run.parse),
        upload: of(|run| run.upload),
        projection: of(|run| run.projection),
        recording: of(|run| run.recording),
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
    /// Microseconds of compiling all pipelines, once.
    pub(super) pipelines_us: f64,
    /// Times with the file in the page cache.
    pub(super) warm_us: Steps,
    /// Times with the page cache dropped before every read; absent where the system cannot.
    pub(super) cold_us: Option<Steps>,
    /// Parts of `parse`, and what to compare them with.
    #[serde(flatten)]
    pub(super) parts_us: BTreeMap<String, f64>,
}
