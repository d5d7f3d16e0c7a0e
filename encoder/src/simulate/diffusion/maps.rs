//! Media from an artist's images: weights of measured materials, or diffuse albedo and mean free path.

use std::path::{Path, PathBuf};

use image::codecs::hdr::HdrDecoder;
use image::imageops::{FilterType, resize};
use image::{DynamicImage, ImageFormat, ImageReader, Rgb32FImage};

use super::medium::{MEASURED, Medium};
use super::slab::MediumMap;
use crate::error::{Error, Result};

/// How much of a material there is at every pixel.
#[derive(Clone, Debug)]
pub enum Weight {
    /// The grey value of an image, 0 to 1, as it is stored (no gamma).
    Image(PathBuf),
    /// The same weight everywhere.
    Constant(f64),
    /// Rest that the other weights leave of 1.
    Rest,
}

/// Mean free path of every pixel and channel.
#[derive(Clone, Debug)]
pub enum MeanFreePath {
    /// The same everywhere, in mm.
    Constant([f64; 3]),
    /// An image's values as they are stored: 0 stands for the first length, 1 for the second, in mm.
    Image(PathBuf, [f64; 2]),
}

/// Quantiles that `stretch` spreads to 0 and 1.
const STRETCH: [f64; 2] = [0.01, 0.99];

/// Mixes measured materials, given by name, with weights at every pixel.
///
/// Images are resampled to `size`. Weights that add up to more than 1 are scaled down to 1; so are others, up or down,
/// unless one of them is [`Weight::Rest`]. With `stretch`, each image's 1st to 99th percentile is spread to 0 .. 1.
///
/// # Errors
/// For unknown names, unreadable images, and pixels with no material at all.
pub fn mixture(parts: &[(String, Weight)], size: [usize; 2], stretch: bool) -> Result<MediumMap> {
    let mut planes = Vec::new();
    let mut rest = None;
    for (name, weight) in parts {
        let medium = Medium::measured(name).ok_or_else(|| {
            let known: Vec<&str> = MEASURED.iter().map(|(name, _)| *name).collect();
            Error::Request(format!("no measured material \"{name}\"; there are {}", known.join(", ")))
        })?;
        let plane = match weight {
            Weight::Image(path) => grey(path, size, stretch)?,
            Weight::Constant(value) if !(value.is_finite() && *value >= 0.0) => {
                return Err(Error::Request(format!(
                    "a weight of {value} for {name}; weights are finite and not negative"
                )));
            }
            Weight::Constant(value) => vec![*value; size[0] * size[1]],
            Weight::Rest if rest.is_some() => {
                return Err(Error::Request("two materials ask for the rest; only one can have it".to_owned()));
            }
            Weight::Rest => {
                rest = Some(planes.len());
                Vec::new()
            }
        };
        planes.push((medium, plane));
    }
    let mix = |pixel: usize| {
        let weights = planes.iter().map(|(_, plane)| plane.get(pixel).copied().unwrap_or(0.0).max(0.0));
        let mut weights: Vec<f64> = weights.collect();
        let given: f64 = weights.iter().sum();
        if let Some(rest) = rest {
            weights[rest] = (1.0 - given).max(0.0);
        }
        let sum: f64 = weights.iter().sum();
        if sum <= 0.0 {
            let [x, y] = [pixel % size[0], pixel / size[0]];
            let message = format!("no material at pixel ({x}, {y}): all weights are 0; give one the value \"rest\"");
            return Err(Error::Request(message));
        }
        Ok(Medium::mix(planes.iter().zip(&weights).map(|((medium, _), weight)| (weight / sum, *medium))))
    };
    let media = (0..size[0] * size[1]).map(mix).collect::<Result<_>>()?;
    Ok(MediumMap { size, media })
}

/// Media with the diffuse albedo of an image (sRGB, or linear where the format is), inverted with [`Medium::from_albedo`].
///
/// # Errors
/// For unreadable images and lengths that are not positive.
pub fn albedo(image: &Path, mean_free_path: &MeanFreePath, size: [usize; 2], eta: f64) -> Result<MediumMap> {
    let albedo = linear(image, size)?;
    let lengths: Vec<[f64; 3]> = match mean_free_path {
        MeanFreePath::Constant(lengths) => vec![*lengths; size[0] * size[1]],
        MeanFreePath::Image(path, [from, to]) => {
            let stored = load(path, size, Meaning::Data)?;
            let length = |value: f32| from + f64::from(value.clamp(0.0, 1.0)) * (to - from);
            stored.pixels().map(|rgb| rgb.0.map(length)).collect()
        }
    };
    if let Some(length) = lengths.iter().flatten().find(|length| !(length.is_finite() && **length > 0.0)) {
        return Err(Error::Request(format!("a mean free path of {length} mm; it must be positive")));
    }
    let media = albedo.iter().zip(lengths).map(|(albedo, length)| Medium::from_albedo(*albedo, length, eta));
    Ok(MediumMap { size, media: media.collect() })
}

fn unreadable(path: &Path, error: impl std::fmt::Display) -> Error {
    Error::input(path, error, "an image (PNG, JPEG or Radiance HDR)")
}

/// How an image's values are meant.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Meaning {
    /// Colours: 8- and 16-bit images are sRGB, and become linear Rec. 709.
    Colour,
    /// Numbers, as they are stored; 8-bit ones divided by 255.
    Data,
}

/// An image resampled to `size`; colours are averaged as light is, after they are made linear.
fn load(path: &Path, size: [usize; 2], meaning: Meaning) -> Result<Rgb32FImage> {
    let reader = ImageReader::open(path).map_err(|error| unreadable(path, error))?;
    let reader = reader.with_guessed_format().map_err(|error| unreadable(path, error))?;
    let is_linear = reader.format() == Some(ImageFormat::Hdr);
    let image = if is_linear {
        // Many programs sign their files "#?RGBE" instead of "#?RADIANCE".
        HdrDecoder::new_nonstrict(reader.into_inner()).and_then(DynamicImage::from_decoder)
    } else {
        reader.decode()
    };
    let mut image = image.map_err(|error| unreadable(path, error))?.into_rgb32f();
    if meaning == Meaning::Colour && !is_linear {
        for rgb in image.pixels_mut() {
            rgb.0 = rgb.0.map(from_srgb);
        }
    }
    let [width, height] = size.map(|n| u32::try_from(n).expect("a side is below 65,536"));
    // A triangle as wide as a target pixel: averages when it shrinks, interpolates when it enlarges.
    Ok(resize(&image, width, height, FilterType::Triangle))
}

/// Linear value of an sRGB one (IEC 61966-2-1), 0 to 1.
fn from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Linear Rec. 709 values.
fn linear(path: &Path, size: [usize; 2]) -> Result<Vec<[f64; 3]>> {
    Ok(load(path, size, Meaning::Colour)?.pixels().map(|rgb| rgb.0.map(f64::from)).collect())
}

/// Mean of the three channels as they are stored.
fn grey(path: &Path, size: [usize; 2], stretch: bool) -> Result<Vec<f64>> {
    let stored = load(path, size, Meaning::Data)?;
    let mut values: Vec<f64> =
        stored.pixels().map(|rgb| rgb.0.iter().map(|&v| f64::from(v)).sum::<f64>() / 3.0).collect();
    if stretch {
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        let [low, high] = STRETCH.map(|quantile| {
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                clippy::cast_precision_loss,
                reason = "an index into the values"
            )]
            let at = (quantile * (sorted.len() - 1) as f64).round() as usize;
            sorted[at]
        });
        for value in &mut values {
            *value = if high > low { (*value - low) / (high - low) } else { 0.0 };
        }
    }
    for value in &mut values {
        *value = value.clamp(0.0, 1.0);
    }
    Ok(values)
}
