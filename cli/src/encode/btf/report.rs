//! What is said of a BTF that was encoded.

use std::path::Path;

use serde_json::json;
use subsurf_encoder::btf::{Encoded, Size};
use subsurf_encoder::metrics::btf::BtfError;
use subsurf_encoder::rate::btf::Point;
use subsurf_viewer::human;

use crate::compare::{mssim, mssim_json};
use crate::outln;
use crate::program::memory::resident;

/// Facts about one run.
pub(super) struct Report<'a> {
    pub(super) output: &'a Path,
    pub(super) encoded: &'a Encoded,
    pub(super) raw_bytes: u64,
    pub(super) seconds: f64,
    pub(super) error: BtfError,
}

/// Line about one file that was tried.
pub(super) fn line(point: &Point<Size>) -> String {
    let (size, error) = (human(point.bytes() as u64), point.distortion);
    format!("  {size:>8}  {:<14}  {}  PSNR {:.1} dB", name(&point.candidate), mssim(&error), error.psnr_db)
}

/// Size of a file for people.
fn name(size: &Size) -> String {
    match size {
        Size::Nested(extent) => format!("P4 = {} × {}", extent.p4, extent.stages),
        Size::Factored { most_bytes } => format!("at most {}", human(*most_bytes)),
        Size::Havran2010 { looseness } => format!("thresholds × {looseness:.3}"),
    }
}

impl Report<'_> {
    pub(super) fn json(&self) {
        let of_error = |error: &BtfError| json!({ "mssim": mssim_json(error), "psnr_db": error.psnr_db });
        let points = self.encoded.curve.as_ref().map(|curve| {
            let point = |(number, point): (usize, &Point<Size>)| {
                let (sizes, error) = (name(&point.candidate), of_error(&point.distortion));
                json!({ "chosen": number == curve.best, "sizes": sizes, "bytes": point.bytes(), "error": error })
            };
            curve.points.iter().enumerate().map(point).collect::<Vec<_>>()
        });
        let value = json!({
            "file": self.output, "sizes": name(&self.encoded.size), "bytes": self.encoded.bytes.len(), "raw_bytes": self.raw_bytes,
            "error": of_error(&self.error), "curve": points, "seconds": self.seconds,
            "peak_rss_bytes": resident().unwrap_or_default().peak,
        });
        outln!("{value:#}");
    }

    pub(super) fn print(&self) {
        let bytes = self.encoded.bytes.len();
        #[allow(clippy::cast_precision_loss, reason = "a ratio for people")]
        let ratio = self.raw_bytes as f64 / bytes as f64;
        let (size, raw) = (human(bytes as u64), human(self.raw_bytes));
        outln!("{}: {size} from {raw}, 1:{ratio:.0}; {}", self.output.display(), name(&self.encoded.size));
        let error = self.error;
        outln!("  {}, PSNR {:.1} dB over {} pairs of directions", mssim(&error), error.psnr_db, error.pairs);
        outln!("  {:.1} s, {} of memory", self.seconds, human(resident().unwrap_or_default().peak));
    }
}
