//! Results of the study, and how they are looked up.

use std::path::Path;

use super::plan::Fit;
use super::record::{Record, capture_name, picture_path};

/// Results of the study so far, all that its page is made from.
pub(super) struct Results<'a> {
    /// Folder of the study.
    pub(super) folder: &'a Path,
    pub(super) materials: &'a [String],
    pub(super) records: &'a [Record],
    pub(super) fits: &'a [Fit],
    /// Pixels of a patch.
    pub(super) size: [usize; 2],
    /// Pixels to a side of the window.
    pub(super) window: u32,
    pub(super) pitch_mm: f64,
    /// Photons of the captures with noise, if there are any.
    pub(super) photons: Option<f64>,
    /// Length of a capture.
    pub(super) capture_bytes: u64,
}

impl Results<'_> {
    /// Record of a fit of a material.
    pub(super) fn find(&self, material: &str, noisy: bool, label: &str) -> Option<&Record> {
        self.records.iter().find(|r| r.material == material && r.noisy == noisy && r.label == label)
    }

    /// Name of a fit for people.
    pub(super) fn title(&self, label: &str) -> String {
        let fit = self.fits.iter().find(|fit| fit.label == label);
        fit.map_or_else(|| label.to_owned(), |fit| fit.title.clone())
    }

    /// Labels of the paper's own fits that were made.
    pub(super) fn papers(&self) -> impl Iterator<Item = &str> {
        self.fits.iter().map(|fit| fit.label.as_str()).filter(|label| label.starts_with("paper"))
    }

    /// Labels of the fits that are compared with each other.
    pub(super) fn labels_compared(&self) -> Vec<&str> {
        let mut labels = vec!["song", "clusters-equal", "k1", "k1-equal", "k2", "k3", "k5"];
        labels.extend(self.papers());
        labels
    }

    /// Captures without noise and, if there are any, with noise.
    pub(super) fn halves(&self) -> Vec<(bool, &'static str)> {
        let mut halves = vec![(false, "without noise")];
        if self.records.iter().any(|record| record.noisy) {
            halves.push((true, "with noise"));
        }
        halves
    }

    /// Width and height of a patch in mm.
    pub(super) fn mm(&self) -> [f64; 2] {
        #[allow(clippy::cast_precision_loss, reason = "a length on a picture")]
        self.size.map(|side| side as f64 * self.pitch_mm)
    }

    /// PNG of what a fit made of a material.
    pub(super) fn picture(&self, material: &str, noisy: bool, label: &str, what: &str) -> Option<Vec<u8>> {
        std::fs::read(picture_path(self.folder, &capture_name(material, noisy), label, what)).ok()
    }
}
