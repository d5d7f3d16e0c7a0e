//! Records: what came of a material through a codec, cached on disk, as it takes minutes.

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use subsurf_cli::info::Parts;
use subsurf_cli::picture::{display, write_picture};
use subsurf_cli::program::progress::Bars;
use subsurf_decoder::btf::Evaluate;
use subsurf_encoder::btf::TruncatedSvd;
use subsurf_encoder::capture::Images;
use subsurf_encoder::metrics::btf::{BtfError, compare, compare_images, decode, with_file};
use subsurf_encoder::write_bytes;
use subsurf_viewer::human;

use super::codec::{Codec, Made};
use crate::cache;

/// Pairs of directions that are shown: shares of all of them.
pub(super) const PICTURED: [f64; 3] = [0.12, 0.52, 0.73];

/// Record: what came of a material through a codec.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct Record {
    /// What it answers; another one is another question.
    request: String,
    pub(super) material: String,
    pub(super) label: String,
    pub(super) bytes: u64,
    pub(super) raw_bytes: u64,
    /// Mean structural similarity of Y, Cr and Cb.
    pub(super) mssim: [f64; 3],
    pub(super) psnr_db: f64,
    pub(super) seconds: f64,
    /// Evaluations in a second on one core, light, view and texel at random.
    pub(super) evaluations: Option<f64>,
    /// Name, entries, and how many vectors each codebook stands for.
    pub(super) books: Vec<(String, u32, u64)>,
}

impl Record {
    pub(super) fn mean_mssim(&self) -> f64 {
        self.mssim.iter().sum::<f64>() / 3.0
    }

    pub(super) fn line(&self) -> String {
        let ([luma, ..], mean) = (self.mssim, self.mean_mssim());
        let size = size(self.bytes, self.raw_bytes);
        format!("{:<20} {size:>18}  MSSIM {mean:.4} (Y {luma:.4})  {:.1} dB", self.label, self.psnr_db)
    }
}

/// Material of the study, to be sent through codecs.
pub(super) struct CodecCase<'a> {
    pub(super) name: &'a str,
    /// Pixels of its images in x and in y.
    pub(super) side: u32,
    pub(super) folder: &'a Path,
    pub(super) every: usize,
    /// Its images, and what the codecs share, once something is not cached.
    pub(super) images: Vec<Images>,
    pub(super) svd: Option<TruncatedSvd>,
}

impl CodecCase<'_> {
    fn cached(&self, codec: Codec) -> PathBuf {
        self.folder.join("files").join(format!("{}-{}-{}.json", self.name, self.side, codec.label()))
    }

    fn read(&self, codec: Codec) -> Option<Record> {
        cache::read(&self.cached(codec))
    }

    /// The record of a codec, the cached one if it is still the answer; none if it cannot be as small as it may be.
    pub(super) fn record(
        &mut self,
        codec: Codec,
        load: impl FnOnce() -> anyhow::Result<Images>,
    ) -> anyhow::Result<Option<Record>> {
        let budget = codec.budget_of().and_then(|other| self.read(other)).map_or(0, |record| record.bytes);
        let request = format!("{} {codec:?} {budget} every {}", env!("CARGO_PKG_VERSION"), self.every);
        if let Some(cached) = self.read(codec).filter(|cached| cached.request == request) {
            return Ok(Some(cached));
        }
        if self.images.is_empty() {
            self.images.push(load()?);
        }
        let start = Instant::now();
        let made = codec.make(self.name, &self.images, &mut self.svd, budget)?;
        let seconds = start.elapsed().as_secs_f64();
        let judged = made.into_iter().map(|made| Ok((self.judge(&made)?, made)));
        let judged: Vec<(BtfError, Made)> = judged.collect::<anyhow::Result<_>>()?;
        // All have a similarity: images of a study are larger than its window.
        let quality = |error: &BtfError| error.mean_mssim().unwrap_or(0.0);
        let best = judged.into_iter().max_by(|(a, _), (b, _)| quality(a).total_cmp(&quality(b)));
        let Some((error, made)) = best else { return Ok(None) };
        self.draw(codec, &made)?;
        let path = self.cached(codec);
        let (mut books, mut evaluations) = (Vec::new(), None);
        if let Made::File(bytes) = &made {
            write_bytes(&path.with_extension("subsurf"), bytes)?;
            if let Parts::Codebooks(found) = Parts::of(&path, bytes)? {
                books = found.iter().map(|book| (book.name.clone(), book.entries, book.stands_for)).collect();
            }
            evaluations = Some(with_file(bytes, |file| evaluations_per_second(file))?);
        }
        let record = Record {
            request,
            material: self.name.to_owned(),
            label: codec.label().to_owned(),
            bytes: made.bytes(),
            raw_bytes: self.images[0].bytes(),
            mssim: error.mssim.unwrap_or_default(),
            psnr_db: error.psnr_db,
            seconds,
            evaluations,
            books,
        };
        cache::write(&path, &record)?;
        Ok(Some(record))
    }

    fn judge(&self, made: &Made) -> anyhow::Result<BtfError> {
        let images = &self.images[0];
        let pairs: Vec<usize> = (0..images.pairs()).step_by(self.every).collect();
        Ok(match made {
            Made::File(bytes) => with_file(bytes, |file| compare(images, file, 0, &pairs, &Bars::new()))?,
            Made::Baseline(baseline) => {
                compare_images(images, images.tone(), &pairs, |pair| baseline.image(pair), &Bars::new())
            }
        })
    }

    /// Pictures at a few pairs, and the originals.
    fn draw(&self, codec: Codec, made: &Made) -> anyhow::Result<()> {
        let images = &self.images[0];
        for (number, share) in PICTURED.iter().enumerate() {
            let pair = images.pair_at(*share);
            let decoded = match made {
                Made::File(bytes) => with_file(bytes, |file| decode(images, file, 0, pair))?,
                Made::Baseline(baseline) => baseline.image(pair),
            };
            let width = images.size()[0];
            write_picture(
                &picture_path(self.folder, self.name, codec.label(), number),
                &display(&decoded, width, None),
            )?;
            let original = display(&images.image(pair), width, None);
            write_picture(&picture_path(self.folder, self.name, "original", number), &original)?;
        }
        Ok(())
    }
}

pub(super) fn picture_path(folder: &Path, material: &str, label: &str, number: usize) -> PathBuf {
    folder.join("pictures").join(format!("btf-{material}-{label}-{number}.png"))
}

/// Texels, lights and views at random, for a fifth of a second at least.
fn evaluations_per_second(file: &dyn Evaluate) -> f64 {
    let Some([width, height]) = file.catalog().materials().next().map(|material| material.size(0)) else {
        return 0.0;
    };
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 8
    };
    #[allow(clippy::cast_precision_loss, reason = "24 bits")]
    let mut unit = || random() as f32 / 16_777_216.0;
    let mut direction = || {
        let (z, phi) = (0.3 + 0.7 * unit(), std::f32::consts::TAU * unit());
        let across = (1.0 - z * z).sqrt();
        [across * phi.cos(), across * phi.sin(), z]
    };
    let queries: Vec<[[f32; 3]; 2]> = (0..4_096).map(|_| [direction(), direction()]).collect();
    let (width, height) = (width.cast_signed(), height.cast_signed());
    let texels: Vec<_> = (0..4_096_i32)
        .filter_map(|k| file.catalog().texel(0, 0, [k.wrapping_mul(7_919) % width, k.wrapping_mul(104_729) % height]))
        .collect();
    let (start, mut count) = (Instant::now(), 0_u32);
    while start.elapsed() < Duration::from_millis(200) {
        for (texel, [light, view]) in texels.iter().zip(&queries) {
            black_box(file.eval(*texel, *light, *view));
            count += 1;
        }
    }
    f64::from(count) / start.elapsed().as_secs_f64()
}

/// Bytes for people, and their ratio to the bytes of all images.
pub(super) fn size(bytes: u64, raw_bytes: u64) -> String {
    #[allow(clippy::cast_precision_loss, reason = "a ratio for people")]
    let ratio = raw_bytes as f64 / bytes.max(1) as f64;
    format!("{}, 1:{ratio:.0}", human(bytes))
}
