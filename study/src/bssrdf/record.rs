//! Records: what came of the fits of a capture, cached in the study's folder.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use flate2::Compression;
use flate2::write::DeflateEncoder;
use serde::{Deserialize, Serialize};
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::BssrdfModel;
use subsurf_encoder::bssrdf::{self, Method, Options, base_materials_within, file_bytes};
use subsurf_encoder::capture::Capture;
use subsurf_encoder::metrics::bssrdf::{Judgement, Light, judge};
use subsurf_encoder::write_bytes;

use super::plan::Fit;
use crate::cache;
use crate::page::colour::{error_map, grey_map};
use subsurf_cli::picture::{linear, write_picture};
use subsurf_cli::program::progress::Bars;

/// Record: what came of one fit. Judged by the capture without noise, whatever it was fitted to.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct Record {
    pub(super) material: String,
    pub(super) noisy: bool,
    pub(super) label: String,
    /// Options and capture, to see whether a cached record is still the answer.
    request: String,
    pub(super) per_pixel: usize,
    pub(super) base_materials: usize,
    pub(super) bytes: u64,
    /// From the capture to the file, in seconds.
    pub(super) seconds: f64,
    pub(super) relative_error: f64,
    /// In dB, by light in the order of [`Light::ALL`].
    pub(super) psnr_db: [Option<f64>; 3],
    pub(super) ssim: [Option<f64>; 3],
    /// Mean of the largest, second largest .. ratio of all pixels.
    pub(super) sorted_ratios: Vec<f64>,
    /// Length of the file deflated and as an LZ4 block.
    pub(super) deflated: u64,
    pub(super) lz4: u64,
}

/// Capture of the study, to be fitted.
pub(super) struct FitCase<'a> {
    pub(super) material: &'a str,
    pub(super) noisy: bool,
    pub(super) capture: &'a Capture,
    /// The same capture without noise, by which fits are judged.
    pub(super) truth: &'a Capture,
    pub(super) folder: &'a Path,
}

impl FitCase<'_> {
    pub(super) fn name(&self) -> String {
        capture_name(self.material, self.noisy)
    }

    /// The record of a fit: the cached one if it is still the answer, else fits; true if it had to.
    pub(super) fn record(&self, fit: &Fit) -> anyhow::Result<(Record, bool)> {
        let options = self.settled(fit)?;
        let capture = self.capture;
        let shape = [capture.width(), capture.height(), capture.radius()];
        let source = (capture.pitch_mm(), capture.addressing(), capture.eta(), capture.simulated());
        let request = format!("{} {options:?} {shape:?} {source:?}", env!("CARGO_PKG_VERSION"));
        let path = self.folder.join("fits").join(format!("{}-{}.json", self.name(), fit.label));
        if let Some(cached) = cache::read::<Record>(&path)
            && cached.request == request
        {
            return Ok((cached, false));
        }
        let start = Instant::now();
        let encoded = bssrdf::encode(self.capture, None, &options, &Bars::new())?;
        let seconds = start.elapsed().as_secs_f64();
        let material = Bssrdf::parse(&encoded.bytes)?;
        let judgement = judge(self.truth, &material, encoded.bytes.len() as u64, &Bars::new())?;
        write_bytes(&path.with_extension("subsurf"), &encoded.bytes)?;
        let sorted_ratios = self.draw(&fit.label, &judgement, &material)?;
        let record = Record {
            material: self.material.to_owned(),
            noisy: self.noisy,
            label: fit.label.clone(),
            request,
            per_pixel: encoded.per_pixel,
            base_materials: encoded.base_materials,
            bytes: encoded.bytes.len() as u64,
            seconds,
            relative_error: judgement.relative_error_mean,
            psnr_db: judgement.psnr_db,
            ssim: judgement.ssim,
            sorted_ratios,
            deflated: deflated(&encoded.bytes)?,
            lz4: lz4_flex::block::compress(&encoded.bytes).len() as u64,
        };
        cache::write(&path, &record)?;
        Ok((record, true))
    }

    /// Options of a fit, with M chosen where it is to have the bytes of another.
    fn settled(&self, fit: &Fit) -> anyhow::Result<Options> {
        if !fit.equal_bytes {
            return Ok(fit.options);
        }
        let two = Options { per_pixel: 2, method: Method::Direct, ..fit.options };
        let limit = file_bytes(self.capture, None, &two)?;
        let base_materials = base_materials_within(self.capture, None, &fit.options, limit)?.max(1);
        Ok(Options { base_materials, ..fit.options })
    }

    /// Small pictures for the page: under every light, the errors, and the sorted ratios, whose means it gives.
    fn draw(&self, label: &str, judgement: &Judgement, material: &Bssrdf<'_>) -> anyhow::Result<Vec<f64>> {
        let width = u32::try_from(self.capture.width())?;
        let picture = |what: &str| picture_path(self.folder, &self.name(), label, what);
        for (light, relit) in Light::ALL.iter().zip(&judgement.comparison.lit) {
            if let Some(relit) = relit.normalised() {
                write_picture(&picture(light.name()), &linear(&relit.image, width, 1))?;
                let original = picture_path(self.folder, &self.name(), "original", light.name());
                write_picture(&original, &linear(&relit.reference, width, 1))?;
            }
        }
        write_picture(&picture("error"), &error_map(&judgement.comparison.albedo.relative_errors(), width))?;
        let ranks = sorted_ratios(material);
        for (rank, map) in ranks.iter().enumerate().filter(|_| ranks.len() > 2) {
            write_picture(&picture(&format!("ratio{}", rank + 1)), &grey_map(map, width))?;
        }
        #[allow(clippy::cast_precision_loss, reason = "pixels fit in 2⁵³")]
        let mean = |map: &Vec<f32>| map.iter().map(|&t| f64::from(t)).sum::<f64>() / map.len() as f64;
        Ok(ranks.iter().map(mean).collect())
    }
}

/// Length once deflated, as in an APK.
fn deflated(bytes: &[u8]) -> std::io::Result<u64> {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    Ok(encoder.finish()?.len() as u64)
}

/// Capture with or without noise, in file names.
pub(super) fn capture_name(material: &str, noisy: bool) -> String {
    if noisy { format!("{material}-noisy") } else { material.to_owned() }
}

pub(super) fn picture_path(folder: &Path, capture: &str, label: &str, what: &str) -> PathBuf {
    folder.join("pictures").join(format!("{capture}-{label}-{what}.png"))
}

/// The largest ratio of every pixel, the second largest, ..: K maps.
fn sorted_ratios(material: &Bssrdf<'_>) -> Vec<Vec<f32>> {
    let BssrdfModel::BaseMaterials(model) = material.model() else {
        return Vec::new();
    };
    let header = material.header();
    let pixels = (header.width * header.height) as usize;
    let k = usize::from(header.model);
    let mut maps = vec![Vec::with_capacity(pixels); k];
    for pixel in 0..pixels {
        let mut ratios = model.mixtures.at(pixel, pixels).ratios;
        ratios.sort_by(|a, b| b.total_cmp(a));
        for (map, t) in maps.iter_mut().zip(ratios) {
            map.push(t);
        }
    }
    maps
}
