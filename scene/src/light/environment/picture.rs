//! Pictures of radiance in equirectangular projection.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

/// Picture of radiance in equirectangular projection.
pub(super) struct Picture {
    /// Width and height in pixels.
    pub(super) size: [u32; 2],
    /// Radiance, linear Rec. 709, `[row][column]`.
    pub(super) pixels: Vec<Vec3>,
}

impl Picture {
    /// Picture at another size; each pixel is the mean of the light in its solid angle.
    pub(super) fn resized(&self, size: [u32; 2]) -> Self {
        let columns = shares(self.size[0], size[0], |u| u);
        let rows = shares(self.size[1], size[1], |v| -(std::f64::consts::PI * v).cos());
        let mean =
            |of: &[Vec3], shares: &[(usize, f32)]| shares.iter().map(|&(at, share)| of[at] * share).sum::<Vec3>();
        let narrow = self.pixels.chunks_exact(self.size[0] as usize);
        let narrow: Vec<Vec<Vec3>> =
            narrow.map(|row| columns.iter().map(|shares| mean(row, shares)).collect()).collect();
        let texel = |x: usize, shares: &[(usize, f32)]| shares.iter().map(|&(y, share)| narrow[y][x] * share).sum();
        let pixels = rows.iter().flat_map(|shares| (0..columns.len()).map(move |x| texel(x, shares))).collect();
        Self { size, pixels }
    }

    /// Radiance from a unit direction, linear between texels; around in u, not over the poles.
    pub(super) fn radiance(&self, direction: Vec3) -> Vec3 {
        let [width, height] = self.size.map(i64::from);
        let uv = Vec2::new(0.5 + direction.x.atan2(direction.z) / TAU, direction.y.clamp(-1.0, 1.0).acos() / PI);
        let at = uv * size_of(self.size) - 0.5;
        let (low, part) = (at.floor(), at - at.floor());
        #[allow(clippy::cast_possible_truncation, reason = "within a texel of the picture")]
        let [x, y] = low.to_array().map(|k| k as i64);
        let texel = |x: i64, y: i64| {
            let at = y.clamp(0, height - 1) * width + x.rem_euclid(width);
            self.pixels[usize::try_from(at).expect("clamped to the picture")]
        };
        let row = |y| texel(x, y).lerp(texel(x + 1, y), part.x);
        row(y).lerp(row(y + 1), part.y)
    }
}

/// For each of `to` texels along an axis, which of `from` texels it covers, and which share of it each covers.
///
/// `measure` grows along the axis, over 0 to 1; shares are of its differences, and sum to 1.
fn shares(from: u32, to: u32, measure: impl Fn(f64) -> f64) -> Vec<Vec<(usize, f32)>> {
    let (n_from, n_to) = (u64::from(from), u64::from(to));
    let measure_at = |k: u64, n: u64| measure(k as f64 / n as f64);
    let texel = |k: u64| {
        let (low, high) = (measure_at(k, n_to), measure_at(k + 1, n_to));
        let covered = k * n_from / n_to..=((k + 1) * n_from - 1) / n_to;
        let share = |at: u64| {
            let part = measure_at(at + 1, n_from).min(high) - measure_at(at, n_from).max(low);
            (usize::try_from(at).expect("pictures are in memory"), single(part / (high - low)))
        };
        covered.map(share).collect()
    };
    (0..n_to).map(texel).collect()
}

/// Width and height as floats.
pub(super) fn size_of([width, height]: [u32; 2]) -> Vec2 {
    Vec2::new(width as f32, height as f32)
}

/// Value rounded to single precision.
#[allow(clippy::cast_possible_truncation, reason = "rounded")]
pub(super) fn single(value: f64) -> f32 {
    value as f32
}
