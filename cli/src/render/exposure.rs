//! Exposure, and pictures averaged down.

use image::RgbImage;
use subsurf_shaders::{Rgb, cpu};
use subsurf_viewer::light_of;

/// Display value that the brightest parts get when the exposure is chosen.
pub(super) const BRIGHT: f32 = 0.75;
/// Pictures are drawn this much larger and averaged down, so that edges are smooth.
pub(super) const SUPERSAMPLING: u32 = 2;

/// The exposure that brings all but the brightest hundredth below [`BRIGHT`].
pub(super) fn exposure_for<'a>(lights: impl Iterator<Item = &'a Rgb>) -> f32 {
    let mut values: Vec<f32> = lights.map(|rgb| rgb.iter().copied().fold(0.0, f32::max)).collect();
    values.sort_by(f32::total_cmp);
    let bright = values.get(values.len() * 99 / 100).copied().unwrap_or(0.0);
    if bright > 0.0 { BRIGHT / bright } else { 1.0 }
}

/// Means of blocks of pixels, taken of light rather than of display values.
pub(super) fn average_down(pixels: &[[u8; 3]], size: [u32; 2]) -> RgbImage {
    let light: Vec<f32> = (0..=255_u8).map(|value| light_of([value; 3])[0]).collect();
    let n = SUPERSAMPLING;
    RgbImage::from_fn(size[0] / n, size[1] / n, |x, y| {
        let mut sum = [0.0; 3];
        for (dx, dy) in (0..n).flat_map(|dy| (0..n).map(move |dx| (dx, dy))) {
            let pixel = pixels[((y * n + dy) * size[0] + x * n + dx) as usize];
            for c in 0..3 {
                sum[c] += light[usize::from(pixel[c])];
            }
        }
        #[allow(clippy::cast_precision_loss, reason = "a handful")]
        let count = (n * n) as f32;
        image::Rgb(cpu::display(cpu::srgb(sum.map(|sum| sum / count))))
    })
}
