//! Media from an artist's images: weights of measured materials, or diffuse albedo and mean free path.

use std::path::{Path, PathBuf};

use subsurf_decoder::bssrdf::layout::LENGTHS_MM;

use super::medium::{MEASURED, Medium};
use super::request::check_eta;
use super::slab::MediumMap;
use crate::error::{Error, Result};
use crate::picture::Picture;
use crate::progress::Progress;

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
/// Values out of range are clamped, and `progress` hears how many.
///
/// # Errors
/// For unknown names, unreadable images, and pixels with no material at all.
pub fn mixture(
    parts: &[(String, Weight)],
    size: [usize; 2],
    stretch: bool,
    progress: &dyn Progress,
) -> Result<MediumMap> {
    let mut planes = Vec::new();
    let mut rest = None;
    for (name, weight) in parts {
        let medium = Medium::measured(name).ok_or_else(|| {
            let known: Vec<&str> = MEASURED.iter().map(|(name, _)| *name).collect();
            Error::Request(format!("no measured material \"{name}\"; there are {}", known.join(", ")))
        })?;
        let plane = match weight {
            Weight::Image(path) => grey(path, size, stretch, progress)?,
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

/// Media with the diffuse albedo of an image (sRGB, or linear where its values are floats), inverted with
/// [`Medium::from_albedo`]. Values out of range are clamped, and `progress` hears how many.
///
/// # Errors
/// For unreadable images and lengths that are not positive.
pub fn albedo(
    image: &Path,
    mean_free_path: &MeanFreePath,
    size: [usize; 2],
    eta: f64,
    progress: &dyn Progress,
) -> Result<MediumMap> {
    check_eta(eta)?;
    let albedo = load(image, size, Meaning::Colour, progress)?;
    let lengths: Vec<[f64; 3]> = match mean_free_path {
        MeanFreePath::Constant(lengths) => vec![*lengths; size[0] * size[1]],
        MeanFreePath::Image(path, [from, to]) => {
            let stored = load(path, size, Meaning::Data, progress)?;
            let length = |value: f32| from + f64::from(value.clamp(0.0, 1.0)) * (to - from);
            stored.pixels().iter().map(|rgb| rgb.map(length)).collect()
        }
    };
    let [shortest, longest] = LENGTHS_MM.map(f64::from);
    if let Some(length) = lengths.iter().flatten().find(|length| !(shortest..=longest).contains(*length)) {
        return Err(Error::Request(format!(
            "a mean free path of {length} mm; it must be positive, from {shortest} to {longest} mm"
        )));
    }
    let media = albedo.pixels().iter().zip(lengths);
    let media = media.map(|(albedo, length)| Medium::from_albedo(albedo.map(f64::from), length, eta));
    Ok(MediumMap { size, media: media.collect() })
}

/// How an image's values are meant.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Meaning {
    /// Colours, 0 to 1: those of integers are sRGB, and become linear Rec. 709.
    Colour,
    /// Numbers as they are stored, 0 to 1.
    Data,
    /// Numbers of any range that are not negative.
    Unscaled,
}

/// An image resampled to `size`; colours are averaged as light is, after they are made linear.
fn load(path: &Path, size: [usize; 2], meaning: Meaning, progress: &dyn Progress) -> Result<Picture> {
    let mut picture = Picture::open(path)?;
    let pixels = picture.pixels().len();
    if meaning == Meaning::Colour {
        picture = picture.into_linear();
    }
    let (largest, range) = match meaning {
        Meaning::Colour | Meaning::Data => (1.0, "0 to 1"),
        Meaning::Unscaled => (picture.largest(), "finite and not negative"),
    };
    let clamped = picture.clamp(largest);
    if clamped > 0 {
        let path = path.display();
        progress
            .warn(&format!("{path}: {clamped} of {pixels} pixels have values that are not {range}; they are clamped"));
    }
    if picture.transparent() > 0 {
        let (path, transparent) = (path.display(), picture.transparent());
        progress.warn(&format!("{path}: {transparent} of {pixels} pixels are transparent, which is left out"));
    }
    Ok(picture.resized(size.map(|n| u32::try_from(n).expect("a side is below 65,536"))))
}

/// Mean of the three channels as they are stored.
fn grey(path: &Path, size: [usize; 2], stretch: bool, progress: &dyn Progress) -> Result<Vec<f64>> {
    let meaning = if stretch { Meaning::Unscaled } else { Meaning::Data };
    let stored = load(path, size, meaning, progress)?;
    let mut values: Vec<f64> =
        stored.pixels().iter().map(|rgb| rgb.iter().map(|&v| f64::from(v)).sum::<f64>() / 3.0).collect();
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
