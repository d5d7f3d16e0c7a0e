//! Files as the authors' program reads them (github.com/tatsy/linsss-vulkan), little-endian: width, height, number H of Gaussians and
//! pixels to a side of the window, each 32 bits; of every pixel, row by row, the weights `[h][rgb]` in double precision; 1 / σ²
//! `[h][rgb]`, likewise, σ in pixels.

use super::MAX_GAUSSIANS;
use super::model::LinSss;

/// Bytes of the four numbers at the start.
const HEADER_BYTES: usize = 16;

impl LinSss {
    /// Bytes of a file.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let numbers = [self.size[0], self.size[1], self.sigmas.len(), 2 * self.radius + 1];
        let number = |number: usize| u32::try_from(number).expect("sides are below 65,536").to_le_bytes();
        let mut bytes: Vec<u8> = numbers.into_iter().flat_map(number).collect();
        let mut push = |value: f32| bytes.extend(f64::from(value).to_le_bytes());
        for pixel in 0..self.size[0] * self.size[1] {
            self.weights.iter().flatten().for_each(|plane| push(plane[pixel]));
        }
        self.sigmas.iter().flatten().for_each(|sigma| push(1.0 / (sigma * sigma)));
        bytes
    }

    /// Material of a file, whose pixels are `pitch_mm` apart. `None` if it is none.
    #[must_use]
    pub fn parse(bytes: &[u8], pitch_mm: f32) -> Option<Self> {
        let (header, values) = bytes.split_at_checked(HEADER_BYTES)?;
        let number = |k: usize| Some(u32::from_le_bytes(header[4 * k..][..4].try_into().ok()?) as usize);
        let [width, height, gaussians, window] = [number(0)?, number(1)?, number(2)?, number(3)?];
        let pixels = width.checked_mul(height).filter(|pixels| *pixels > 0)?;
        let count = pixels.checked_add(1)?.checked_mul(3 * gaussians)?;
        let is_in_range = (1..=MAX_GAUSSIANS).contains(&gaussians) && width.max(height) < 1 << 16 && window < 2 << 10;
        if !is_in_range || window % 2 == 0 || values.len() != count.checked_mul(8)? {
            return None;
        }
        #[allow(clippy::cast_possible_truncation, reason = "single precision")]
        let values: Vec<f32> =
            values.as_chunks::<8>().0.iter().map(|value| f64::from_le_bytes(*value) as f32).collect();
        if values.iter().any(|value| !(value.is_finite() && *value >= 0.0)) {
            return None;
        }
        let value = |pixel: usize, h: usize, c: usize| values[(pixel * gaussians + h) * 3 + c];
        let plane = |h: usize, c: usize| (0..pixels).map(|pixel| value(pixel, h, c)).collect();
        Some(Self {
            size: [width, height],
            radius: window / 2,
            pitch_mm,
            sigmas: (0..gaussians).map(|h| [0, 1, 2].map(|c| value(pixels, h, c).max(1e-4).recip().sqrt())).collect(),
            weights: (0..gaussians).map(|h| [0, 1, 2].map(|c| plane(h, c))).collect(),
        })
    }
}
