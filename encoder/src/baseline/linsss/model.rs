//! A fitted material, and the patch under a light.

use super::convolve::{convolve, gaussian, mass, of_ones};
use super::pyramid::{Pyramid, sampled_variance};
use crate::capture::Capture;

/// Material as weights of Gaussians. Lengths are in pixels of the patch, colours linear Rec. 709.
#[derive(Clone, Debug)]
pub struct LinSss {
    /// Pixels in x and y.
    pub size: [usize; 2],
    /// Radius of the capture's window in pixels, beyond which nothing was measured.
    pub radius: usize,
    /// Distance of neighbouring pixels in mm.
    pub pitch_mm: f32,
    /// Standard deviations σ_h, by channel; shape `[h][rgb]`.
    pub sigmas: Vec<[f32; 3]>,
    /// Weights W_h of every pixel, at least 0; shape `[h][rgb][pixel]`.
    pub weights: Vec<[Vec<f32>; 3]>,
}

impl LinSss {
    /// Material from standard deviations and weights of each channel.
    pub(super) fn new(capture: &Capture, channels: &[(Vec<f64>, Vec<Vec<f32>>)]) -> Self {
        let gaussians = channels[0].0.len();
        #[allow(clippy::cast_possible_truncation, reason = "single precision")]
        let sigma = |h: usize| [0, 1, 2].map(|c| channels[c].0[h] as f32);
        Self {
            size: [capture.width(), capture.height()],
            radius: capture.radius(),
            pitch_mm: capture.pitch_mm(),
            sigmas: (0..gaussians).map(sigma).collect(),
            weights: (0..gaussians).map(|h| [0, 1, 2].map(|c| channels[c].1[h].clone())).collect(),
        }
    }

    /// Bytes of textures as the authors' program makes them: W and G * W, each as four floats of single precision.
    #[must_use]
    pub fn device_bytes(&self) -> u64 {
        (2 * self.size[0] * self.size[1] * self.sigmas.len() * 16) as u64
    }

    /// Standard deviations in pixels and weights of Gaussians on the plane, of the integral 1, by which a renderer draws: those of a
    /// fit are at whole pixels, of which the window shows a part, and have a smaller variance where σ is below a pixel. Weights
    /// are linear Rec. 709, shape `[h][pixel]`.
    #[must_use]
    pub fn on_the_plane(&self) -> (Vec<[f32; 3]>, Vec<Vec<[f32; 3]>>) {
        #[allow(clippy::cast_possible_truncation, reason = "single precision")]
        let of = |(sigmas, planes): (&[f32; 3], &[Vec<f32>; 3])| {
            let masses = sigmas.map(|sigma| {
                let kernel = gaussian(sigma.into(), self.radius);
                mass(&kernel).powi(2) as f32
            });
            let weights = (0..planes[0].len()).map(|pixel| [0, 1, 2].map(|c| masses[c] * planes[c][pixel])).collect();
            (sigmas.map(|sigma| sampled_variance(sigma.into()).sqrt() as f32), weights)
        };
        self.sigmas.iter().zip(&self.weights).map(of).unzip()
    }

    /// Exitance under an irradiance of every pixel, by all pairs within the window:
    /// M = ½ Σ_h (W_h (G_h * E) + G_h * (W_h E)), row by row.
    ///
    /// # Panics
    /// If `irradiance` is shorter than the patch.
    #[must_use]
    pub fn exitance(&self, irradiance: &[f32]) -> Vec<[f64; 3]> {
        self.lit(|h, c| {
            let kernel = gaussian(self.sigmas[h][c].into(), self.radius);
            let weights = &self.weights[h][c];
            let weighted: Vec<f32> = weights.iter().zip(irradiance).map(|(w, e)| w * e).collect();
            let (of_light, of_both) =
                (convolve(irradiance, &kernel, self.size), convolve(&weighted, &kernel, self.size));
            weights.iter().zip(of_light).zip(of_both).map(|((w, light), both)| w * light + both).collect()
        })
    }

    /// The same as the authors' program draws it: M = ½ Σ_h (W_h + G_h * W_h) (G_h * E), where the light convolved with every
    /// Gaussian is looked up between the levels of one pyramid. Nothing is cut off at the window.
    ///
    /// # Panics
    /// If `irradiance` is shorter than the patch.
    #[must_use]
    pub fn exitance_by_pyramid(&self, irradiance: &[f32]) -> Vec<[f64; 3]> {
        let pyramid = Pyramid::new(irradiance, self.size);
        self.lit(|h, c| {
            let sigma = f64::from(self.sigmas[h][c]);
            // Weights of the whole Gaussian, of which the fit saw the part within the window, at whole pixels.
            let kernel = gaussian(sigma, self.radius);
            let mass = mass(&kernel);
            let kernel: Vec<f64> = kernel.iter().map(|value| value / mass).collect();
            let inside = of_ones(&kernel, self.size);
            let weights = &self.weights[h][c];
            // Beyond the border there is no material: its weights go on as inside.
            let mean: Vec<f32> =
                convolve(weights, &kernel, self.size).iter().zip(inside).map(|(sum, inside)| sum / inside).collect();
            #[allow(clippy::cast_possible_truncation, reason = "single precision")]
            let mass = (mass * mass) as f32;
            let light = pyramid.blurred(sigma);
            weights.iter().zip(mean).zip(light).map(|((w, mean), light)| mass * (w + mean) * light).collect()
        })
    }

    /// Half the sum over all Gaussians of a plane by Gaussian and channel.
    fn lit(&self, plane: impl Fn(usize, usize) -> Vec<f32>) -> Vec<[f64; 3]> {
        let mut sums = vec![[0.0; 3]; self.size[0] * self.size[1]];
        for (h, c) in (0..self.sigmas.len()).flat_map(|h| (0..3).map(move |c| (h, c))) {
            sums.iter_mut().zip(plane(h, c)).for_each(|(sum, value)| sum[c] += 0.5 * f64::from(value));
        }
        sums
    }
}
