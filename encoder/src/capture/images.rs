//! All images of a BTF in memory: display values in 8 or 16 bits, or half floats of linear ones.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use glam::Vec3;
use half::f16;
use rayon::prelude::*;
use subsurf_decoder::btf::ColourEncoding;

use crate::capture::source::Source;
use crate::error::{Error, Result};
use crate::memory;
use crate::picture::PixelFormat;
use crate::progress::Progress;

/// The images of one material: three numbers of 8 or 16 bits a pixel, or three half floats where they are linear.
#[derive(Debug)]
pub struct Images {
    label: String,
    lights: Vec<Vec3>,
    views: Vec<Vec3>,
    size: [u32; 2],
    tone: ColourEncoding,
    raw_bytes: Option<u64>,
    /// `[light][view][pixel][rgb]`.
    pixels: Store,
}

#[derive(Debug)]
enum Store {
    Display(Vec<u8>),
    Deep(Vec<u16>),
    Linear(Vec<f16>),
}

/// The toe of [`ColourEncoding::LogLuv`], in mean luminances.
const TOE_OF_MEAN: f32 = 0.05;

/// Largest linear value that is kept: that of half floats.
const BRIGHTEST: f32 = 65_504.0;

/// All display values of images of `image` values each, rounded.
fn display<T: Copy + Default + Send + Sync>(
    values: usize,
    image: usize,
    read: impl Fn(usize) -> Result<Vec<[f32; 3]>> + Sync,
    round: impl Fn(f32) -> T + Sync,
) -> Result<Vec<T>> {
    let mut all = vec![T::default(); values];
    all.par_chunks_mut(image).enumerate().try_for_each(|(pair, image)| -> Result<()> {
        for (rounded, value) in image.iter_mut().zip(read(pair)?.as_flattened()) {
            *rounded = round(value.clamp(0.0, 1.0));
        }
        Ok(())
    })?;
    Ok(all)
}

/// All linear values of images of `image` values each, in half precision, and how bright they are.
fn linear(
    values: usize,
    image: usize,
    read: impl Fn(usize) -> Result<Vec<[f32; 3]>> + Sync,
) -> Result<(Vec<f16>, ColourEncoding)> {
    let mut halves = vec![f16::ZERO; values];
    let peak = AtomicU32::new(0);
    let sums: Vec<f32> = halves
        .par_chunks_mut(image)
        .enumerate()
        .map(|(pair, image)| -> Result<f32> {
            let mut sum = 0.0;
            let pixels = read(pair)?;
            for (halves, rgb) in image.as_chunks_mut::<3>().0.iter_mut().zip(&pixels) {
                // NaN and -0 become 0.
                let kept = |value: f32| if value > 0.0 { value.min(BRIGHTEST) } else { 0.0 };
                *halves = rgb.map(|value| f16::from_f32(kept(value)));
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

/// Pixels that are not kept as they are.
fn outside(pixels: &[[f32; 3]]) -> u64 {
    pixels.iter().filter(|rgb| rgb.iter().any(|value| !(0.0..=BRIGHTEST).contains(value))).count() as u64
}

/// Says what was left out of a source, and what is changed in it.
fn warn(source: &dyn Source, outside: u64, pixels: usize, progress: &dyn Progress) {
    source.warnings().iter().for_each(|warning| progress.warn(warning));
    if outside > 0 {
        let label = source.label();
        progress.warn(&format!(
            "{label}: {outside} of {pixels} pixels have values that are not 0 to {BRIGHTEST}; they are clamped, NaN to 0"
        ));
    }
}

/// Reads every image of a source, one at a time, and keeps none: says what [`Images::load`] would.
///
/// # Errors
/// The first image that cannot be read.
pub fn check_images(source: &dyn Source, progress: &dyn Progress) -> Result<()> {
    let (lights, views) = (source.lights().len(), source.views().len());
    progress.begin("reading images", (lights * views) as u64);
    let of_pair = |pair: usize| -> Result<[u64; 2]> {
        let pixels = source.read(pair / views, pair % views)?;
        progress.advance(1);
        Ok([outside(&pixels), pixels.len() as u64])
    };
    let sum = |a: [u64; 2], b: [u64; 2]| Ok([a[0] + b[0], a[1] + b[1]]);
    let [outside, pixels] = (0..lights * views).into_par_iter().map(of_pair).try_reduce(|| [0; 2], sum)?;
    warn(source, outside, usize::try_from(pixels).unwrap_or(usize::MAX), progress);
    Ok(())
}

impl Images {
    /// All images of a source.
    ///
    /// # Errors
    /// The first that cannot be read; [`Error::Request`] if they take more memory than there is.
    pub fn load(source: &dyn Source, progress: &dyn Progress) -> Result<Self> {
        let (lights, views, size) = (source.lights(), source.views(), source.size());
        let pairs = lights.len() * views.len();
        let [width, height] = size.map(|side| side as usize);
        let image = width.checked_mul(height).and_then(|texels| texels.checked_mul(3));
        let values =
            image.and_then(|image| image.checked_mul(pairs)).filter(|values| *values < isize::MAX as usize / 2);
        let Some((image, values)) = image.zip(values) else {
            return Err(Error::Request(format!("{}: too many pixels", source.label())));
        };
        let bytes = match source.format() {
            PixelFormat::Display8 => 1,
            PixelFormat::Display16 | PixelFormat::Linear => 2,
        };
        memory::expect(values as u64 * bytes, || format!("{}: {pairs} images", source.label()))?;
        progress.begin("reading images", pairs as u64);
        let clamped = AtomicU64::new(0);
        let read = |pair: usize| {
            let pixels = source.read(pair / views.len(), pair % views.len())?;
            clamped.fetch_add(outside(&pixels), Ordering::Relaxed);
            progress.advance(1);
            Ok(pixels)
        };
        let tone = ColourEncoding::Display { white: source.white() };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let (pixels, tone) = match source.format() {
            PixelFormat::Display8 => {
                let bytes = display(values, image, read, |value| (value * 255.0).round() as u8)?;
                (Store::Display(bytes), tone)
            }
            PixelFormat::Display16 => {
                let words = display(values, image, read, |value| (value * 65_535.0).round() as u16)?;
                (Store::Deep(words), tone)
            }
            PixelFormat::Linear => {
                let (halves, tone) = linear(values, image, read)?;
                (Store::Linear(halves), tone)
            }
        };
        warn(source, clamped.into_inner(), values / 3, progress);
        Ok(Self { label: source.label(), lights, views, size, tone, raw_bytes: source.raw_bytes(), pixels })
    }

    /// Name in errors.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.label
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
            Store::Display(bytes) => bytes.len() as u64,
            Store::Deep(words) => 2 * words.len() as u64,
            Store::Linear(halves) => 2 * halves.len() as u64,
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
            Store::Display(bytes) => {
                for (texel, rgb) in bytes[range].as_chunks().0.iter().enumerate() {
                    with(texel, rgb.map(|byte| f32::from(byte) * (1.0 / 255.0)));
                }
            }
            Store::Deep(words) => {
                for (texel, rgb) in words[range].as_chunks().0.iter().enumerate() {
                    with(texel, rgb.map(|word| f32::from(word) * (1.0 / 65_535.0)));
                }
            }
            Store::Linear(halves) => {
                for (texel, rgb) in halves[range].as_chunks().0.iter().enumerate() {
                    with(texel, rgb.map(f16::to_f32));
                }
            }
        }
    }
}
