//! Colours: maps of numbers as pictures.

use image::{Rgb, RgbImage};
use plotters::style::colors::colormaps::{ColorMap, ViridisRGB};
use subsurf_cli::picture;
use subsurf_shaders::cpu::display;

/// Relative errors that the two ends of the scale stand for; the scale is logarithmic.
pub(crate) const ERRORS: [f64; 2] = [1e-4, 1e-1];
/// Colour of pixels where nothing was measured.
const NOTHING: Rgb<u8> = Rgb([128; 3]);

/// Colour of a place on the scale, 0 to 1.
pub(crate) fn colour(place: f64) -> Rgb<u8> {
    let plotters::style::RGBColor(r, g, b) = ViridisRGB.get_color(place.clamp(0.0, 1.0));
    Rgb([r, g, b])
}

/// Picture of relative errors, on the logarithmic scale of [`ERRORS`].
pub(crate) fn error_map(errors: &[Option<f64>], width: u32) -> RgbImage {
    let [low, high] = ERRORS.map(f64::ln);
    let place = |error: f64| (error.max(f64::MIN_POSITIVE).ln() - low) / (high - low);
    map(errors, width, |error| error.map_or(NOTHING, |error| colour(place(error))))
}

/// Shade of a number from 0, black, to 1, white.
pub(crate) fn grey(value: f32) -> Rgb<u8> {
    Rgb(display([value; 3]))
}

/// Picture of numbers from 0, black, to 1, white.
pub(crate) fn grey_map(values: &[f32], width: u32) -> RgbImage {
    map(values, width, grey)
}

fn map<T: Copy>(values: &[T], width: u32, colour: impl Fn(T) -> Rgb<u8>) -> RgbImage {
    let pixels: Vec<[u8; 3]> = values.iter().map(|&value| colour(value).0).collect();
    picture::image(&pixels, width)
}
