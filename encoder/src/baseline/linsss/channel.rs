//! One colour channel of a fit: what is minimised, as a quadratic form of the weights.
//!
//! F = ½ Σ_ij (½ Σ_h g_h(r_ij) (W_h(i) + W_h(j)) − R_ij)² + ½ λ Σ_i (m(i) − a(i))², over all pairs of a window, with
//! m(i) = ½ Σ_h (S_h(i) W_h(i) + (g_h * W_h)(i)), S_h = g_h * 1 and a(i) = Σ_j R_ij, the exitance under uniform light. All sums
//! over pairs are convolutions, as g_h g_k is again a product of functions of dx and dy.

use super::convolve::{convolve, gaussian, of_ones};
use super::sums::RingSums;

/// λ, the weight of the exitance under uniform light beside that of the pairs.
const EXITANCE: f32 = 1.0;

/// Sums of one channel of a capture.
pub(super) struct Channel<'a> {
    pub(super) sums: &'a RingSums,
    /// Σ_j R_ij at one distance, shape `[distance][pixel]`.
    rings: &'a [Vec<f32>],
    squares: f64,
    /// Exitance a under uniform light.
    albedo: Vec<f32>,
}

/// The form for one set of standard deviations.
pub(super) struct Form<'a> {
    channel: &'a Channel<'a>,
    /// g_h along one axis, shape `[h][distance]`.
    kernels: Vec<Vec<f64>>,
    /// g_h g_k along one axis and its convolution with 1, shape `[h][k]`, k ≤ h.
    products: Vec<Vec<(Vec<f64>, Vec<f32>)>>,
    /// S_h.
    reach: Vec<Vec<f32>>,
    /// b_h(i) = Σ_j g_h(r_ij) R_ij.
    targets: Vec<Vec<f32>>,
}

/// Value of F, and its gradient.
pub(super) struct Value {
    pub(super) cost: f64,
    pub(super) gradient: Vec<Vec<f32>>,
}

impl<'a> Channel<'a> {
    pub(super) fn new(sums: &'a RingSums, c: usize) -> Self {
        let rings = &sums.of[c];
        let mut albedo = vec![0.0; sums.size[0] * sums.size[1]];
        rings.iter().for_each(|ring| albedo.iter_mut().zip(ring).for_each(|(sum, value)| *sum += value));
        Self { sums, rings, squares: sums.squares[c], albedo }
    }

    /// The form for standard deviations in pixels.
    pub(super) fn form(&'a self, sigmas: &[f64]) -> Form<'a> {
        let RingSums { size, radius, r2, .. } = self.sums;
        let kernels: Vec<Vec<f64>> = sigmas.iter().map(|sigma| gaussian(*sigma, *radius)).collect();
        let product = |a: &[f64], b: &[f64]| -> (Vec<f64>, Vec<f32>) {
            let kernel: Vec<f64> = a.iter().zip(b).map(|(a, b)| a * b).collect();
            let ones = of_ones(&kernel, *size);
            (kernel, ones)
        };
        let products =
            (0..kernels.len()).map(|h| (0..=h).map(|k| product(&kernels[h], &kernels[k])).collect()).collect();
        let target = |sigma: &f64| {
            let mut sum = vec![0.0_f32; self.albedo.len()];
            for (r2, ring) in r2.iter().zip(self.rings) {
                #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "single precision")]
                let g = ((-0.5 * *r2 as f64 / (sigma * sigma)).exp() / (std::f64::consts::TAU * sigma * sigma)) as f32;
                sum.iter_mut().zip(ring).for_each(|(sum, value)| *sum += g * value);
            }
            sum
        };
        Form {
            channel: self,
            reach: kernels.iter().map(|kernel| of_ones(kernel, *size)).collect(),
            targets: sigmas.iter().map(target).collect(),
            kernels,
            products,
        }
    }

    pub(super) fn pixels(&self) -> usize {
        self.albedo.len()
    }
}

impl Form<'_> {
    pub(super) fn gaussians(&self) -> usize {
        self.kernels.len()
    }

    /// F and its gradient at some weights, shape `[h][pixel]`.
    pub(super) fn at(&self, weights: &[Vec<f32>]) -> Value {
        let size = self.channel.sums.size;
        let count = self.gaussians();
        // Exitance under uniform light, less what it should be: e = m − a.
        let mut excess: Vec<f32> = self.channel.albedo.iter().map(|a| -a).collect();
        for h in 0..count {
            let spread = convolve(&weights[h], &self.kernels[h], size);
            for (((excess, s), w), spread) in excess.iter_mut().zip(&self.reach[h]).zip(&weights[h]).zip(&spread) {
                *excess += 0.5 * (s * w + spread);
            }
        }
        let mut cost = 0.5 * self.channel.squares + 0.5 * f64::from(EXITANCE) * dot(&excess, &excess);
        let mut gradient = Vec::with_capacity(count);
        for h in 0..count {
            // q_h = ½ Σ_k (S_hk W_k + g_h g_k * W_k).
            let mut q = vec![0.0_f32; excess.len()];
            for (k, weights) in weights.iter().enumerate() {
                let (kernel, ones) = &self.products[h.max(k)][h.min(k)];
                let spread = convolve(weights, kernel, size);
                for (((q, s), w), spread) in q.iter_mut().zip(ones).zip(weights).zip(&spread) {
                    *q += 0.5 * (s * w + spread);
                }
            }
            cost += 0.5 * dot(&weights[h], &q) - dot(&weights[h], &self.targets[h]);
            let spread = convolve(&excess, &self.kernels[h], size);
            for (pixel, q) in q.iter_mut().enumerate() {
                *q += 0.5 * EXITANCE * (self.reach[h][pixel] * excess[pixel] + spread[pixel]) - self.targets[h][pixel];
            }
            gradient.push(q);
        }
        Value { cost, gradient }
    }

    /// Matrix M of a majorant: the form's Hessian is nowhere larger than M for every pixel apart.
    ///
    /// Of the pairs it is Σ_j g g^T over a whole window, as (w_i + w_j)² ≤ 2 w_i² + 2 w_j². Of m(i) = Σ_j u_ij · W(j), with
    /// u_ij = ½ (S δ_ij + g(r_ij)), it is Σ_j (s / |u_j|) u_j u_j^T with s = Σ_j |u_j| (Jensen).
    pub(super) fn majorant(&self) -> Vec<Vec<f64>> {
        let count = self.gaussians();
        let radius = i64::try_from(self.channel.sums.radius).expect("a window radius is below 1,024");
        let mut matrix = vec![vec![0.0; count]; count];
        let whole: Vec<f64> = self.kernels.iter().map(|k| (2.0 * k.iter().sum::<f64>() - k[0]).powi(2)).collect();
        let all: f64 = whole.iter().sum();
        for [dx, dy] in (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| [dx, dy])) {
            let [x, y] = [dx, dy].map(|d| usize::try_from(d.unsigned_abs()).expect("within the window"));
            let g: Vec<f64> = self.kernels.iter().map(|kernel| kernel[x] * kernel[y]).collect();
            let own = if [dx, dy] == [0, 0] { 1.0 } else { 0.0 };
            let u: Vec<f64> = g.iter().zip(&whole).map(|(g, s)| 0.5 * (own * s + g)).collect();
            let share = f64::from(EXITANCE) * all / u.iter().sum::<f64>().max(1e-300);
            for (h, row) in matrix.iter_mut().enumerate() {
                for (k, value) in row.iter_mut().enumerate() {
                    *value += g[h] * g[k] + share * u[h] * u[k];
                }
            }
        }
        matrix
    }
}

/// Σ a b, in double precision.
pub(super) fn dot(a: &[f32], b: &[f32]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
}
