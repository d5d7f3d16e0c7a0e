//! A pyramid of smaller and smaller pictures of the light, between whose levels any Gaussian is looked up.

use super::convolve::{convolve, gaussian, mass};

/// Weights of the filter before a plane is halved, at offsets −1, 0, 1, 2 of a pixel's two: binomial, of variance 3/4.
const HALVING: [f32; 4] = [0.125, 0.375, 0.375, 0.125];
/// Weights at 0 and 1 pixel of the first blur, of variance 1/4, and of the second, which is done twice and adds 3/4.
const FIRST: [f64; 2] = [0.75, 0.125];
const SECOND: [f64; 2] = [0.625, 0.1875];
/// The same of what makes a halved level as smooth as the one before, in its own pixels: 9/16, the variance that is missing to 1.
const SMOOTHING: [f64; 2] = [0.4375, 0.281_25];
/// Variance that linear interpolation adds on average, in pixels of its level.
const INTERPOLATION: f64 = 1.0 / 6.0;

/// Levels of a plane: itself, blurred by a half and by one pixel, and from there on each half as large as the one before; black around.
pub(super) struct Pyramid {
    size: [usize; 2],
    /// Size in pixels and values.
    levels: Vec<([usize; 2], Vec<f32>)>,
    /// Standard deviation with which a level shows the plane, in pixels of the finest.
    sigmas: Vec<f64>,
    /// Pixels of black on every side.
    margin: usize,
}

impl Pyramid {
    pub(super) fn new(plane: &[f32], size: [usize; 2]) -> Self {
        // Light beyond the border is black, as far as the widest level looks.
        let margin = size[0].max(size[1]).next_power_of_two() / 2;
        let padded = size.map(|side| (side + 2 * margin).next_power_of_two());
        let mut first = vec![0.0; padded[0] * padded[1]];
        for (y, row) in plane.chunks_exact(size[0]).take(size[1]).enumerate() {
            first[(y + margin) * padded[0] + margin..][..size[0]].copy_from_slice(row);
        }
        let slight = convolve(&first, &FIRST, padded);
        let smooth = convolve(&convolve(&slight, &SECOND, padded), &SECOND, padded);
        // From here on every level is blurred by one of its own pixels: linear interpolation hardly shows.
        let mut levels = vec![(padded, first), (padded, slight), (padded, smooth)];
        let (mut sigmas, mut scale) = (vec![0.0, 0.5, 1.0], 1.0_f64);
        while levels[levels.len() - 1].0.iter().all(|side| *side > 8) {
            let (size, plane) = &levels[levels.len() - 1];
            let halved_size = size.map(|side| side / 2);
            levels.push((halved_size, convolve(&halved(plane, *size), &SMOOTHING, halved_size)));
            scale *= 2.0;
            sigmas.push(scale * (1.0 + INTERPOLATION).sqrt());
        }
        Self { size, levels, sigmas, margin }
    }

    /// The plane convolved with a Gaussian, about: linear between the two levels whose variances are around its own.
    pub(super) fn blurred(&self, sigma: f64) -> Vec<f32> {
        let wanted = sampled_variance(sigma);
        let variances: Vec<f64> = self.sigmas.iter().map(|sigma| sigma * sigma).collect();
        let last = variances.len() - 1;
        let above = variances.iter().position(|variance| *variance >= wanted).unwrap_or(last).max(1);
        let [low, high] = [variances[above - 1], variances[above]];
        #[allow(clippy::cast_possible_truncation, reason = "0 to 1")]
        let part = ((wanted - low) / (high - low)).clamp(0.0, 1.0) as f32;
        let pixels = (0..self.size[1]).flat_map(|y| (0..self.size[0]).map(move |x| [x, y]));
        pixels.map(|at| (1.0 - part) * self.sample(above - 1, at) + part * self.sample(above, at)).collect()
    }

    /// A level at a pixel of the finest, linear between its own.
    fn sample(&self, level: usize, at: [usize; 2]) -> f32 {
        let (size, plane) = &self.levels[level];
        #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
        let [x, y] = at.map(|k| ((k + self.margin) as f32 + 0.5) / (1_u32 << level.saturating_sub(2)) as f32 - 0.5);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a margin is around the plane")]
        let [left, top] = [x, y].map(|k| k.floor().max(0.0) as usize);
        #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
        let [u, v] = [x - left as f32, y - top as f32];
        let texel = |dx: usize, dy: usize| plane[(top + dy).min(size[1] - 1) * size[0] + (left + dx).min(size[0] - 1)];
        let row = |dy: usize| (1.0 - u) * texel(0, dy) + u * texel(1, dy);
        (1.0 - v) * row(0) + v * row(1)
    }
}

/// Every second pixel of a plane that is filtered; black around.
fn halved(plane: &[f32], [width, height]: [usize; 2]) -> Vec<f32> {
    let taps = |k: usize, len: usize| {
        HALVING.into_iter().zip(0..).filter_map(move |(tap, step)| {
            let at = (2 * k + step).checked_sub(1).filter(|at| *at < len)?;
            Some((at, tap))
        })
    };
    let mut out = Vec::with_capacity(width * height / 4);
    for (y, x) in (0..height / 2).flat_map(|y| (0..width / 2).map(move |x| (y, x))) {
        let row = |row: usize| taps(x, width).map(|(at, tap)| tap * plane[row * width + at]).sum::<f32>();
        out.push(taps(y, height).map(|(at, tap)| tap * row(at)).sum());
    }
    out
}

/// Variance of a Gaussian of σ pixels at whole pixels, as the fit has it: less than σ² where σ is below a pixel.
pub(super) fn sampled_variance(sigma: f64) -> f64 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few dozen pixels")]
    let kernel = gaussian(sigma, (6.0 * sigma).ceil() as usize + 1);
    #[allow(clippy::cast_precision_loss, reason = "a few dozen pixels")]
    let moment: f64 = kernel.iter().enumerate().map(|(d, weight)| 2.0 * weight * (d * d) as f64).sum();
    moment / mass(&kernel)
}
