//! What is said of a BTF that was encoded.

use std::path::Path;

use serde_json::json;
use subsurf_encoder::btf::rate::Point;
use subsurf_encoder::metrics::btf::BtfError;

use super::methods::Made;
use crate::compare::{mssim, mssim_json};
use crate::outln;
use crate::program::memory::resident;
use subsurf_viewer::human;

/// Facts about one run.
pub(super) struct Report<'a> {
    pub(super) output: &'a Path,
    pub(super) made: &'a Made,
    pub(super) raw_bytes: u64,
    pub(super) seconds: f64,
    pub(super) error: BtfError,
}

/// One file that was tried.
pub(super) fn line(point: &Point) -> String {
    let size = human(point.bytes.len() as u64);
    format!("  {size:>8}  {:<14}  {}  PSNR {:.1} dB", point.name, mssim(&point.error), point.error.psnr_db)
}

impl Report<'_> {
    pub(super) fn json(&self) {
        let of_error = |error: &BtfError| json!({ "mssim": mssim_json(error), "psnr_db": error.psnr_db });
        let points = self.made.walked.as_ref().map(|walked| {
            let point = |(number, point): (usize, &Point)| {
                let error = of_error(&point.error);
                json!({ "chosen": number == walked.best, "sizes": point.name, "bytes": point.bytes.len(), "error": error })
            };
            walked.points.iter().enumerate().map(point).collect::<Vec<_>>()
        });
        let value = json!({
            "file": self.output, "sizes": self.made.name, "bytes": self.made.bytes.len(), "raw_bytes": self.raw_bytes,
            "error": of_error(&self.error), "curve": points, "seconds": self.seconds,
            "peak_rss_bytes": resident().unwrap_or_default().peak,
        });
        outln!("{value:#}");
    }

    pub(super) fn print(&self) {
        let bytes = self.made.bytes.len();
        #[allow(clippy::cast_precision_loss, reason = "a ratio for people")]
        let ratio = self.raw_bytes as f64 / bytes as f64;
        let (size, raw) = (human(bytes as u64), human(self.raw_bytes));
        outln!("{}: {size} from {raw}, 1:{ratio:.0}; {}", self.output.display(), self.made.name);
        let error = self.error;
        outln!("  {}, PSNR {:.1} dB over {} pairs of directions", mssim(&error), error.psnr_db, error.pairs);
        outln!("  {:.1} s, {} of memory", self.seconds, human(resident().unwrap_or_default().peak));
    }
}
