//! Convolutions of planes with kernels k(|dx|) k(|dy|); beyond the border of a patch it is black.

/// Values of a Gaussian of σ pixels along one axis at 0, 1 .. `radius` pixels; over the whole line its integral is 1.
pub(super) fn gaussian(sigma: f64, radius: usize) -> Vec<f64> {
    let scale = 1.0 / ((2.0 * std::f64::consts::PI).sqrt() * sigma);
    #[allow(clippy::cast_precision_loss, reason = "a window radius is below 1,024")]
    (0..=radius).map(|d| scale * (-0.5 * (d as f64 / sigma).powi(2)).exp()).collect()
}

/// Sum of a symmetric kernel over both sides, of which it has one from the middle on.
pub(super) fn mass(kernel: &[f64]) -> f64 {
    2.0 * kernel.iter().sum::<f64>() - kernel[0]
}

/// Convolution of a plane of `size` pixels.
pub(super) fn convolve(plane: &[f32], kernel: &[f64], size: [usize; 2]) -> Vec<f32> {
    #[allow(clippy::cast_possible_truncation, reason = "single precision")]
    let kernel: Vec<f32> = kernel.iter().map(|value| *value as f32).collect();
    let width = size[0];
    let mut between = vec![0.0; plane.len()];
    for (row, out) in plane.chunks_exact(width).zip(between.chunks_exact_mut(width)) {
        for (d, weight) in kernel.iter().enumerate().take(width) {
            add(&mut out[d..], *weight, row);
            if d > 0 {
                add(out, *weight, &row[d..]);
            }
        }
    }
    let mut out = vec![0.0; plane.len()];
    for (d, weight) in kernel.iter().enumerate().take(size[1]) {
        let shift = d * width;
        add(&mut out[shift..], *weight, &between);
        if d > 0 {
            add(&mut out, *weight, &between[shift..]);
        }
    }
    out
}

/// Adds weight · from to as many numbers as both have.
fn add(to: &mut [f32], weight: f32, from: &[f32]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to += weight * from;
    }
}

/// Convolution of a plane that is 1 everywhere.
pub(super) fn of_ones(kernel: &[f64], [width, height]: [usize; 2]) -> Vec<f32> {
    let axis = |len: usize| -> Vec<f64> {
        let reach = |x: usize| (0..len).map(|other| kernel.get(x.abs_diff(other)).copied().unwrap_or(0.0)).sum();
        (0..len).map(reach).collect()
    };
    let (xs, ys) = (axis(width), axis(height));
    #[allow(clippy::cast_possible_truncation, reason = "single precision")]
    ys.iter().flat_map(|y| xs.iter().map(move |x| (x * y) as f32)).collect()
}
