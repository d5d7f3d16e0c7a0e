//! All images of a BTF in memory: bytes, or half floats of what bytes do not hold.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use glam::Vec3;
use half::f16;
use rayon::prelude::*;
use subsurf_decoder::btf::ColourEncoding;

use crate::capture::source::Source;
use crate::error::{Error, Result};
use crate::memory::expect;
use crate::progress::Progress;

/// The images of one material: three bytes a pixel, or three half floats where they are linear or deeper than bytes.
#[derive(Debug)]
pub struct Images {
    label: String,
    lights: Vec<Vec3>,
    views: Vec<Vec3>,
    size: [u32; 2],
    tone: ColourEncoding,
    raw_bytes: Option<u64>,
    warnings: Vec<String>,
    /// `[light][view][pixel][rgb]`.
    pixels: Store,
}

#[derive(Debug)]
enum Store {
    Bytes(Vec<u8>),
    Halves(Vec<f16>),
}

/// The toe of [`ColourEncoding::LogLuv`], in mean luminances.
const TOE_OF_MEAN: f32 = 0.05;

/// Reads images of a source, and brings their values into the range that images have.
struct Reader<'a> {
    source: &'a dyn Source,
    views: usize,
    /// The largest value: 1 of display values, that of half floats otherwise.
    largest: f32,
    /// Values that were out of range.
    clamped: AtomicU64,
    progress: &'a dyn Progress,
}

impl<'a> Reader<'a> {
    fn new(source: &'a dyn Source, views: usize, progress: &'a dyn Progress) -> Self {
        let largest = if source.white().is_some() { 1.0 } else { f16::MAX.to_f32() };
        Self { source, views, largest, clamped: AtomicU64::new(0), progress }
    }

    fn read(&self, pair: usize) -> Result<Vec<[f32; 3]>> {
        let mut pixels = self.source.read(pair / self.views, pair % self.views)?;
        let range = 0.0..=self.largest;
        let mut clamped = 0;
        for value in pixels.as_flattened_mut().iter_mut().filter(|value| !range.contains(*value)) {
            *value = if value.is_nan() { 0.0 } else { value.clamp(0.0, self.largest) };
            clamped += 1;
        }
        self.clamped.fetch_add(clamped, Ordering::Relaxed);
        self.progress.advance(1);
        Ok(pixels)
    }

    /// What is to be said of the source once all is read.
    fn warnings(self) -> Vec<String> {
        let mut warnings = self.source.warnings();
        let (clamped, largest) = (self.clamped.into_inner(), self.largest);
        if clamped > 0 {
            let label = self.source.label();
            warnings.push(format!("{label}: {clamped} values are not from 0 to {largest}; they are moved there"));
        }
        warnings
    }
}

/// Reads every image of a source, and keeps none of them: says what [`Images::load`] would, in as little memory as there
/// is.
///
/// # Errors
/// The first image that cannot be read.
pub fn check_images(source: &dyn Source, progress: &dyn Progress) -> Result<Vec<String>> {
    let (lights, views) = (source.lights().len(), source.views().len());
    progress.begin("reading images", (lights * views) as u64);
    let reader = Reader::new(source, views, progress);
    (0..lights * views).into_par_iter().try_for_each(|pair| reader.read(pair).map(drop))?;
    Ok(reader.warnings())
}

impl Images {
    /// All images of a source.
    ///
    /// # Errors
    /// The first that cannot be read; [`Error::Request`] if they do not fit into memory.
    pub fn load(source: &dyn Source, progress: &dyn Progress) -> Result<Self> {
        let (lights, views, size) = (source.lights(), source.views(), source.size());
        let pairs = lights.len() * views.len();
        let sides = size.map(|side| side as usize);
        let image = sides[0].checked_mul(sides[1]).and_then(|texels| texels.checked_mul(3));
        let values = image.and_then(|image| image.checked_mul(pairs)).filter(|values| *values < isize::MAX as usize / 2);
        let Some((image, values)) = image.zip(values) else {
            return Err(Error::Request(format!("{}: too many pixels", source.label())));
        };
        let value_bytes = if source.has_bytes() { 1 } else { 2 };
        expect(values as u64 * value_bytes, || format!("{}: all images", source.label()))?;
        progress.begin("reading images", pairs as u64);
        let reader = Reader::new(source, views.len(), progress);
        let (pixels, tone) = match source.white() {
            Some(white) if source.has_bytes() => {
                let mut bytes = vec![0_u8; values];
                bytes.par_chunks_mut(image).enumerate().try_for_each(|(pair, image)| -> Result<()> {
                    for (byte, value) in image.iter_mut().zip(reader.read(pair)?.as_flattened()) {
                        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
                        let rounded = (value * 255.0).round() as u8;
                        *byte = rounded;
                    }
                    Ok(())
                })?;
                (Store::Bytes(bytes), ColourEncoding::Display { white })
            }
            white => {
                let (halves, log_luv) = halves(&reader, values, image)?;
                (Store::Halves(halves), white.map_or(log_luv, |white| ColourEncoding::Display { white }))
            }
        };
        let (label, raw_bytes, warnings) = (source.label(), source.raw_bytes(), reader.warnings());
        Ok(Self { label, lights, views, size, tone, raw_bytes, warnings, pixels })
    }

    /// Name in errors.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.label
    }

    /// What was changed or left out of the source, a line each.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Unit vectors towards the lights.
    #[must_use]
    pub fn lights(&self) -> &[Vec3] {
        &self.lights
    }

    /// Unit vectors towards the eyes.
    #[must_use]
    pub fn views(&self) -> &[Vec3] {
        &self.views
    }

    /// Pixels in x and in y.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Pixels of an image.
    #[must_use]
    pub fn texels(&self) -> usize {
        self.size.iter().map(|side| *side as usize).product()
    }

    /// Encoding of their channels.
    #[must_use]
    pub fn tone(&self) -> ColourEncoding {
        self.tone
    }

    /// Pairs of a light and a view; pair l · views + v is light l and view v.
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.lights.len() * self.views.len()
    }

    /// The pair at a share of all pairs, 0 to below 1.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a pair of some thousands")]
    pub fn pair_at(&self, share: f64) -> usize {
        (share * self.pairs() as f64) as usize
    }

    /// Bytes of all images, as they are kept, or of what they were made from.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        if let Some(bytes) = self.raw_bytes {
            return bytes;
        }
        match &self.pixels {
            Store::Bytes(bytes) => bytes.len() as u64,
            Store::Halves(halves) => 2 * halves.len() as u64,
        }
    }

    /// All pixels of a pair, row by row.
    #[must_use]
    pub fn image(&self, pair: usize) -> Vec<[f32; 3]> {
        let mut pixels = vec![[0.0; 3]; self.texels()];
        self.each(pair, |texel, rgb| pixels[texel] = rgb);
        pixels
    }

    /// Hands over all pixels of a pair, as images have them, with their numbers.
    pub fn each(&self, pair: usize, mut with: impl FnMut(usize, [f32; 3])) {
        let image = 3 * self.texels();
        let range = pair * image..(pair + 1) * image;
        match &self.pixels {
            Store::Bytes(bytes) => {
                for (texel, rgb) in bytes[range].as_chunks().0.iter().enumerate() {
                    with(texel, rgb.map(|byte| f32::from(byte) * (1.0 / 255.0)));
                }
            }
            Store::Halves(halves) => {
                for (texel, rgb) in halves[range].as_chunks().0.iter().enumerate() {
                    with(texel, rgb.map(f16::to_f32));
                }
            }
        }
    }
}

/// All pixels as half floats, and the encoding of linear ones by their luminances.
fn halves(reader: &Reader<'_>, values: usize, image: usize) -> Result<(Vec<f16>, ColourEncoding)> {
    let mut halves = vec![f16::ZERO; values];
    let peak = AtomicU32::new(0);
    let sums: Vec<f32> = halves
        .par_chunks_mut(image)
        .enumerate()
        .map(|(pair, image)| -> Result<f32> {
            let mut sum = 0.0;
            let pixels = reader.read(pair)?;
            for (halves, rgb) in image.as_chunks_mut::<3>().0.iter_mut().zip(&pixels) {
                *halves = rgb.map(f16::from_f32);
                let [r, g, b] = halves.map(f16::to_f32);
                let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
                sum += luminance;
                // Floats that are not negative order as integers.
                peak.fetch_max(luminance.to_bits(), Ordering::Relaxed);
            }
            Ok(sum / pixels.len() as f32)
        })
        .collect::<Result<_>>()?;
    let mean = sums.iter().sum::<f32>() / sums.len() as f32;
    let toe = (TOE_OF_MEAN * mean).clamp(1e-6, 1e5);
    let peak = f32::from_bits(peak.into_inner()).clamp(2.0 * toe, 1e6);
    Ok((halves, ColourEncoding::LogLuv { toe, peak }))
}
