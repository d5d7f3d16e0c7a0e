//! How alike slices of apparent BRDFs are (Havran et al. 2010, section 4.4).

/// When vectors count as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Similarity {
    /// By mean squared error, of RGB where images are display values, of all three channels where they are linear; of P1
    /// and P2 that of luma, of I1, I2 and C that of both chroma channels.
    ///
    /// P4 allows `threshold`, P3 `factor` times as much, M and P2, which are both 2-D, `factor`² and P1 `factor`³.
    /// I2, I1 and C allow 0.5, 0.2 and 0.1, which we read as squares of the steps of 8-bit images: read as fractions of
    /// the whole range they would allow any colour, and the paper reports tens of colours.
    Mse {
        /// Threshold of whole apparent BRDFs, 1 being the square of white.
        threshold: f32,
        /// Factor from one codebook to the next; 0.4 in the paper.
        factor: f32,
    },
    /// By the 98th percentile of structural similarity, over slices along β in three channels (P4, P3 and M), in luma (P2
    /// and P1) or in both chroma channels (I2, I1 and C).
    ///
    /// The paper leaves open what the window of an apparent BRDF is. Here it is a slice: means, variances and covariance
    /// are over its n_β samples, so that P1 has one value, P2 n_α, P3 n_α n_θ and P4 n_α n_θ n_φ to a channel. The
    /// constants are those of images, (0.01)² and (0.03)², and samples are compared as images have them, the code-vector
    /// being scaled to the mean of what it is compared with.
    Ssim(Allowed),
}

/// How far vectors may be from those of each codebook: mean squared errors, or 1 − structural similarity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allowed {
    /// Threshold of whole apparent BRDFs.
    pub p4: f32,
    /// Threshold of 3-D slices.
    pub p3: f32,
    /// Threshold of 2-D slices with their colours.
    pub merged: f32,
    /// Threshold of luma of 2-D slices.
    pub p2: f32,
    /// Threshold of luma of 1-D slices.
    pub p1: f32,
    /// Threshold of chroma of 2-D slices.
    pub i2: f32,
    /// Threshold of chroma of 1-D slices.
    pub i1: f32,
    /// Threshold of single colours.
    pub colours: f32,
}

impl Allowed {
    /// All thresholds so many times as large.
    pub(super) fn times(self, factor: f32) -> Self {
        let Self { p4, p3, merged, p2, p1, i2, i1, colours } = self;
        Self {
            p4: factor * p4,
            p3: factor * p3,
            merged: factor * merged,
            p2: factor * p2,
            p1: factor * p1,
            i2: factor * i2,
            i1: factor * i1,
            colours: factor * colours,
        }
    }
}

impl Similarity {
    /// All thresholds so many times as large.
    #[must_use]
    pub fn times(self, factor: f32) -> Self {
        match self {
            Self::Mse { threshold, factor: of_levels } => {
                Self::Mse { threshold: factor * threshold, factor: of_levels }
            }
            Self::Ssim(allowed) => Self::Ssim(allowed.times(factor)),
        }
    }

    pub(super) fn allowed(&self) -> Allowed {
        match *self {
            Self::Mse { threshold, factor } => {
                let step = 1.0 / (255.0 * 255.0);
                let two = factor * factor * threshold;
                Allowed {
                    p4: threshold,
                    p3: factor * threshold,
                    merged: two,
                    p2: two,
                    p1: factor * two,
                    i2: 0.5 * step,
                    i1: 0.2 * step,
                    colours: 0.1 * step,
                }
            }
            Self::Ssim(allowed) => allowed,
        }
    }
}
