//! Exposure that suits a picture.

use subsurf_runtime::BACKGROUND;
use subsurf_shaders::{Rgb, cpu};

/// The exposure that brings all but the brightest parts of a first picture below middle values: light materials keep their
/// colours. `draw` draws that picture at an exposure.
pub fn exposure_of(draw: impl FnOnce(f32) -> Vec<[u8; 3]>) -> f32 {
    // So dark that nothing is compressed, which is then undone.
    const DARK: f32 = 0.05;
    const MIDDLE: f32 = 0.5;
    let picture = draw(DARK);
    let mut values: Vec<f32> = picture
        .iter()
        .filter(|pixel| **pixel != [BACKGROUND; 3])
        .map(|pixel| light_of(*pixel).into_iter().fold(0.0, f32::max))
        .collect();
    values.sort_by(f32::total_cmp);
    let bright = values.get(values.len() * 97 / 100).copied().unwrap_or(0.0);
    if bright > 0.0 { DARK * MIDDLE / bright } else { 1.0 }
}

/// Linear light, 0 to 1, of sRGB bytes.
#[must_use]
pub fn light_of(pixel: [u8; 3]) -> Rgb {
    cpu::linear(pixel.map(|value| f32::from(value) / 255.0))
}
