//! What is said of a fit to a capture.

use std::path::Path;

use serde_json::json;
use subsurf_decoder::bssrdf::SeparableBasis;
use subsurf_encoder::bssrdf::{Encoded, Options};
use subsurf_encoder::capture::Capture;
use subsurf_encoder::metrics::bssrdf::Judgement;
use subsurf_encoder::rate::bssrdf::Curve;
use subsurf_viewer::human;

use super::curve::coding_name;
use crate::compare;
use crate::info::{basis_line, basis_to_json};
use crate::outln;
use crate::program::memory::resident;

/// Facts about one run.
pub(super) struct Report<'a> {
    pub(super) capture: &'a Capture,
    pub(super) output: &'a Path,
    pub(super) options: &'a Options,
    pub(super) encoded: &'a Encoded,
    pub(super) seconds: f64,
    pub(super) basis: Option<&'a SeparableBasis<'a>>,
}

impl Report<'_> {
    pub(super) fn print_json(&self, judgement: &Judgement, curve: Option<&Curve>) {
        let memory = resident().unwrap_or_default();
        let encoded = self.encoded;
        let mut value = json!({
            "file": self.output,
            "method": format!("{:?}", self.options.method).to_lowercase(),
            "per_pixel": encoded.per_pixel,
            "coding": coding_name(self.options.coding),
            "half_profiles": self.options.half_profiles,
            "base_materials": encoded.base_materials,
            "samples": encoded.samples,
            "basis": self.basis.map(basis_to_json),
            "cost": encoded.cost,
            "entries": encoded.entries,
            "measured": encoded.measured,
            "stopped": encoded.stopped,
            "seconds": self.seconds,
            "peak_rss_bytes": memory.peak,
            "peak_rss_beside_mapped_bytes": memory.peak.saturating_sub(memory.mapped),
        });
        if let (Some(value), Some(judgement)) = (value.as_object_mut(), compare::to_json(judgement).as_object()) {
            value.extend(judgement.clone());
            if let Some(curve) = curve {
                value.insert("curve".to_owned(), super::curve::to_json(curve));
            }
        }
        outln!("{value:#}");
    }

    pub(super) fn print(&self, judgement: &Judgement, curve: Option<&Curve>) {
        let encoded = self.encoded;
        if let Some(curve) = curve {
            super::curve::print(curve);
        }
        let size = human(encoded.bytes.len() as u64);
        outln!("{}: {size} from {}", self.output.display(), human(self.capture.file_bytes()));
        if encoded.stopped {
            outln!("  interrupted: this is the best model so far");
        }
        let missing = encoded.entries - encoded.measured;
        if missing > 0 {
            #[allow(clippy::cast_precision_loss, reason = "a percentage")]
            let share = 100.0 * missing as f64 / encoded.entries as f64;
            outln!("  {share:.1} % of the entries inside the material were not measured; they weigh nothing");
        }
        if encoded.per_pixel > 0 && encoded.base_materials < self.options.base_materials {
            let asked = self.options.base_materials;
            outln!("  {} of {asked} base materials: no pixel had use for the others", encoded.base_materials);
        }
        compare::print(judgement);
        if let Some(basis) = self.basis {
            outln!("  {}", basis_line(basis));
        }
        let memory = resident().unwrap_or_default();
        let beside_mapped = human(memory.peak.saturating_sub(memory.mapped));
        outln!("  {:.1} s, {beside_mapped} of memory besides the mapped capture", self.seconds);
    }
}
