//! Pairs of images, from a capture and from a file.

/// A patch as it looks from the capture and from a file, linear Rec. 709, row by row.
#[derive(Clone, Debug)]
pub struct Relit {
    /// Image from the capture.
    pub reference: Vec<[f64; 3]>,
    /// Image from the file.
    pub image: Vec<[f64; 3]>,
}

impl Relit {
    /// Two black images of so many pixels.
    pub(super) fn new(pixels: usize) -> Self {
        Self { reference: vec![[0.0; 3]; pixels], image: vec![[0.0; 3]; pixels] }
    }

    /// Adds both images of another patch.
    pub(super) fn add(&mut self, other: &Self) {
        let sums = self.reference.iter_mut().chain(&mut self.image);
        for (sum, value) in sums.zip(other.reference.iter().chain(&other.image)) {
            for c in 0..3 {
                sum[c] += value[c];
            }
        }
    }

    /// Both images divided by the largest value of the reference; `None` if the reference is black.
    #[must_use]
    pub fn normalised(&self) -> Option<Self> {
        let peak = self.reference.iter().flatten().fold(0.0_f64, |peak, &value| peak.max(value));
        if peak <= 0.0 {
            return None;
        }
        let scale = |image: &[[f64; 3]]| image.iter().map(|rgb| rgb.map(|value| value / peak)).collect();
        Some(Self { reference: scale(&self.reference), image: scale(&self.image) })
    }

    /// Mean of [`Relit::relative_errors`] over the pixels that have one.
    #[must_use]
    pub fn mean_relative_error(&self) -> f64 {
        let errors: Vec<f64> = self.relative_errors().into_iter().flatten().collect();
        #[allow(clippy::cast_precision_loss, reason = "pixels fit in 2⁵³")]
        let count = errors.len().max(1) as f64;
        errors.iter().sum::<f64>() / count
    }

    /// Relative error ‖ρ − ρ'‖/‖ρ‖ of every pixel, over the three channels; `None` where the reference is black, for
    /// nothing was measured there.
    #[must_use]
    pub fn relative_errors(&self) -> Vec<Option<f64>> {
        let norm = |rgb: [f64; 3]| rgb.iter().map(|value| value * value).sum::<f64>().sqrt();
        let pairs = self.reference.iter().zip(&self.image);
        pairs
            .map(|(reference, image)| {
                let difference = [0, 1, 2].map(|c| reference[c] - image[c]);
                (norm(*reference) > 0.0).then(|| norm(difference) / norm(*reference))
            })
            .collect()
    }
}
