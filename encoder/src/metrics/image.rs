//! PSNR and SSIM of linear RGB images with peak 1.

/// Peak signal-to-noise ratio in dB of a mean squared error, peak 1; infinite for 0.
pub(super) fn psnr_of_mse_db(mean_squared_error: f64) -> f64 {
    -10.0 * mean_squared_error.log10()
}

/// Peak signal-to-noise ratio in dB over all pixels and channels, peak 1; infinite for equal images.
#[must_use]
pub fn psnr_db(reference: &[[f64; 3]], image: &[[f64; 3]]) -> f64 {
    let squares = reference.iter().flatten().zip(image.iter().flatten()).map(|(a, b)| (a - b) * (a - b));
    #[allow(clippy::cast_precision_loss, reason = "pixels fit in 2⁵³")]
    let mean = squares.sum::<f64>() / (3 * reference.len()) as f64;
    psnr_of_mse_db(mean)
}

/// Side of the Gaussian window in pixels.
const SIDE: usize = 11;
/// Standard deviation of the Gaussian window in pixels.
const SIGMA: f64 = 1.5;
/// Constant of the luminance term, (K₁ L)² with K₁ = 0.01 and L = 1.
const C1: f64 = 0.01 * 0.01;
/// Constant of the contrast term, (K₂ L)² with K₂ = 0.03 and L = 1.
const C2: f64 = 0.03 * 0.03;

/// Structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004), mean over channels: 11 × 11 Gaussian window of
/// σ = 1.5 pixels, L = 1, windows that lie wholly inside. `None` for images smaller than the window.
#[must_use]
pub fn ssim(reference: &[[f64; 3]], image: &[[f64; 3]], width: usize) -> Option<f64> {
    let plane = |pixels: &[[f64; 3]], c: usize| -> Vec<f64> { pixels.iter().map(|rgb| rgb[c]).collect() };
    let channels = [0, 1, 2].map(|c| ssim_of_planes(&plane(reference, c), &plane(image, c), width));
    let [red, green, blue] = channels;
    Some((red? + green? + blue?) / 3.0)
}

/// Structural similarity of one channel, row by row; see [`ssim`].
#[must_use]
pub(super) fn ssim_of_planes(reference: &[f64], image: &[f64], width: usize) -> Option<f64> {
    let height = reference.len() / width;
    if width < SIDE || height < SIDE {
        return None;
    }
    let kernel = kernel();
    // Local means of x, y, x², y², xy.
    let blurred = |f: &dyn Fn(f64, f64) -> f64| {
        let plane: Vec<f64> = reference.iter().zip(image).map(|(x, y)| f(*x, *y)).collect();
        blur(&plane, width, &kernel)
    };
    let (x, y) = (blurred(&|x, _| x), blurred(&|_, y| y));
    let (xx, yy, xy) = (blurred(&|x, _| x * x), blurred(&|_, y| y * y), blurred(&|x, y| x * y));
    let windows = x.len();
    let mut sum = 0.0;
    for k in 0..windows {
        let (vx, vy, cov) = (xx[k] - x[k] * x[k], yy[k] - y[k] * y[k], xy[k] - x[k] * y[k]);
        sum += (2.0 * x[k] * y[k] + C1) * (2.0 * cov + C2) / ((x[k] * x[k] + y[k] * y[k] + C1) * (vx + vy + C2));
    }
    #[allow(clippy::cast_precision_loss, reason = "pixels fit in 2⁵³")]
    let mean = sum / windows as f64;
    Some(mean)
}

fn kernel() -> [f64; SIDE] {
    #[allow(clippy::cast_precision_loss, reason = "small numbers")]
    let weights: [f64; SIDE] = std::array::from_fn(|k| {
        let x = k as f64 - (SIDE / 2) as f64;
        (-x * x / (2.0 * SIGMA * SIGMA)).exp()
    });
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

/// Separable convolution, windows that lie wholly inside.
fn blur(plane: &[f64], width: usize, kernel: &[f64; SIDE]) -> Vec<f64> {
    let inner = width - SIDE + 1;
    let row = |row: &[f64]| -> Vec<f64> {
        let mut sums = vec![0.0; inner];
        for (k, weight) in kernel.iter().enumerate() {
            sums.iter_mut().zip(&row[k..]).for_each(|(sum, value)| *sum += weight * value);
        }
        sums
    };
    let rows: Vec<f64> = plane.chunks_exact(width).flat_map(row).collect();
    let height = plane.len() / width - SIDE + 1;
    let mut sums = vec![0.0; height * inner];
    for (k, weight) in kernel.iter().enumerate() {
        sums.iter_mut().zip(&rows[k * inner..]).for_each(|(sum, value)| *sum += weight * value);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(width: usize, height: usize) -> Vec<[f64; 3]> {
        (0..width * height).map(|k| [(k % width) as f64 / 40.0, (k / width) as f64 / 40.0, 0.5]).collect()
    }

    #[test]
    fn psnr_of_a_constant_difference() {
        let image = vec![[0.5; 3]; 10];
        let other = vec![[0.51; 3]; 10];
        assert!((psnr_db(&image, &other) - 40.0).abs() < 1e-9, "a difference of 0.01 is 40 dB");
        assert_eq!(psnr_db(&image, &image), f64::INFINITY);
    }

    #[test]
    fn ssim_of_equal_images_is_one() {
        let image = ramp(20, 15);
        let found = ssim(&image, &image, 20).unwrap();
        assert!((found - 1.0).abs() < 1e-12, "{found}");
        assert!(ssim(&image[..200], &image[..200], 20).is_none(), "10 rows are no window");
    }

    #[test]
    fn ssim_of_constants_is_the_luminance_term() {
        let (x, y) = (0.4, 0.5);
        let found = ssim(&vec![[x; 3]; 144], &vec![[y; 3]; 144], 12).unwrap();
        let expected = (2.0 * x * y + C1) / (x * x + y * y + C1);
        assert!((found - expected).abs() < 1e-12, "{found} is not {expected}");
    }

    #[test]
    fn ssim_weighs_the_window_as_stated() {
        // One different pixel in the middle of a single window: all moments follow from the kernel's middle weight.
        let reference = vec![[0.0; 3]; 121];
        let mut image = reference.clone();
        image[60] = [1.0; 3];
        let k = kernel()[5] * kernel()[5];
        let expected = C1 * C2 / ((k * k + C1) * (k - k * k + C2));
        let found = ssim(&reference, &image, 11).unwrap();
        assert!((found - expected).abs() < 1e-12, "{found} is not {expected}");
    }
}
