//! `--maps` of `subsurf simulate`: media from an artist's images.

use std::path::PathBuf;

use subsurf_encoder::Progress;
use subsurf_encoder::simulate::diffusion::MediumMap;
use subsurf_encoder::simulate::diffusion::maps::{MeanFreePath, Weight, albedo, mixture};

use crate::program::failure::bad_request;

/// What `--help` says of maps.
pub(super) const HELP: &str = "\
Maps, in one of two ways:
  --maps marble=rest --maps ketchup=veins.png     weights of measured materials (Jensen et al. 2001): an image's grey
                                                  value, a number, or what the others leave of 1
  --maps albedo=colour.jpg --maps mfp=1.5         diffuse albedo of an image, and mean free path in mm: one number,
                                                  three (1.5,1.0,0.6), or an image with its range (mfp.png:0.3:2.0)
Images: PNG, JPEG, WebP, TIFF, TGA, BMP (sRGB), OpenEXR and Radiance HDR (linear).
Materials: apple chicken1 chicken2 cream ketchup marble potato skimmilk skin1 skin2 spectralon wholemilk.

Built-in materials are synthetic patterns of the same measured media; blue-wax has an invented pigment beside them. Nothing
here was measured as a patch.";

/// Media of a patch of `size` pixels from entries NAME=VALUE; `stretch` spreads the values of weights, `eta` is the
/// refractive index.
pub(super) fn read(
    entries: &[String],
    stretch: bool,
    size: [usize; 2],
    eta: f64,
    progress: &dyn Progress,
) -> anyhow::Result<MediumMap> {
    let mut weights = Vec::new();
    let mut colours = None;
    let mut mean_free_path = None;
    for entry in entries {
        let (name, value) = entry.split_once('=').ok_or_else(|| {
            bad_request(format!("--maps {entry}: expected NAME=VALUE, for example marble=rest or albedo=colour.png"))
        })?;
        match name {
            "albedo" => colours = Some(PathBuf::from(value)),
            "mfp" => mean_free_path = Some(parse_mean_free_path(value)?),
            name => weights.push((name.to_owned(), parse_weight(value))),
        }
    }
    match (colours, mean_free_path, weights.is_empty()) {
        (Some(colours), Some(length), true) => Ok(albedo(&colours, &length, size, eta, progress)?),
        (None, None, false) => Ok(mixture(&weights, size, stretch, progress)?),
        (Some(_), None, true) => {
            Err(bad_request("--maps albedo=.. needs --maps mfp=.. too: how far light travels, in mm"))
        }
        (None, Some(_), true) => Err(bad_request("--maps mfp=.. needs --maps albedo=IMAGE too")),
        _ => Err(bad_request("--maps takes either measured materials or albedo and mfp, not both")),
    }
}

fn parse_weight(value: &str) -> Weight {
    match value.parse() {
        Ok(number) => Weight::Constant(number),
        Err(_) if value == "rest" => Weight::Rest,
        Err(_) => Weight::Image(value.into()),
    }
}

fn parse_mean_free_path(value: &str) -> anyhow::Result<MeanFreePath> {
    let numbers = |text: &str, separator: char| -> Option<Vec<f64>> {
        text.split(separator).map(|number| number.trim().parse().ok()).collect()
    };
    if let Some(lengths) = numbers(value, ',') {
        return match lengths[..] {
            [all] => Ok(MeanFreePath::Constant([all; 3])),
            [r, g, b] => Ok(MeanFreePath::Constant([r, g, b])),
            _ => Err(bad_request(format!("--maps mfp={value}: one length in mm, or three for red, green and blue"))),
        };
    }
    // IMAGE:FROM:TO, split from the end: a path may have colons.
    let mut parts = value.rsplitn(3, ':');
    if let (Some(to), Some(from), Some(path)) = (parts.next(), parts.next(), parts.next())
        && let (Ok(from), Ok(to)) = (from.parse(), to.parse())
    {
        return Ok(MeanFreePath::Image(path.into(), [from, to]));
    }
    Err(bad_request(format!("--maps mfp={value}: a length in mm, three of them, or IMAGE:FROM:TO with two lengths")))
}
