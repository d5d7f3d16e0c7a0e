//! The mean profile of a material: what is known of it without its heterogeneity.

use subsurf_decoder::Bssrdf;

/// Pixels that are looked at, at most.
const MOST_PIXELS: u32 = 16_384;
/// 1 / golden ratio: no pattern keeps step with its multiples.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Mean profile of a material: Rd in mm⁻² between two pixels alike, the mean over all pixels of a small patch and over 16,384
/// of a larger one, as a function of their distance.
#[derive(Clone, Debug)]
pub struct MeanProfile {
    /// Natural logarithm of the mean at every node, shape `[S]`, linear Rec. 709.
    logs: Vec<[f32; 3]>,
    r_max_mm: f32,
}

impl MeanProfile {
    /// Mean profile of a file.
    #[must_use]
    pub fn of(material: &Bssrdf<'_>) -> Self {
        let header = material.header();
        let [width, height] = [header.width, header.height];
        let pixels = width.saturating_mul(height);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the patch")]
        let spread = |k: u32| {
            let x = (f64::from(k) * GOLDEN).fract() * f64::from(width);
            let y = (f64::from(k) + 0.5) / f64::from(MOST_PIXELS) * f64::from(height);
            [x as u32, y as u32]
        };
        let count = pixels.min(MOST_PIXELS);
        let place = |k: u32| if pixels > MOST_PIXELS { spread(k) } else { [k % width, k / width] };
        let mut sums = vec![[0.0_f64; 3]; header.samples.into()];
        for pixel in (0..count).map(place) {
            let profile = material.profile(pixel.map(u32::cast_signed));
            for (h, sum) in sums.iter_mut().enumerate() {
                let rd = profile.node(h).map(f32::exp);
                for c in 0..3 {
                    sum[c] += f64::from(rd[c]);
                }
            }
        }
        #[allow(clippy::cast_possible_truncation, reason = "within the range of profiles")]
        let log = |sum: [f64; 3]| sum.map(|sum| (sum / f64::from(count)).ln() as f32);
        Self { logs: sums.into_iter().map(log).collect(), r_max_mm: header.r_max_mm }
    }

    /// Reflectance R(r) in mm⁻², linear Rec. 709; 0 beyond r_max.
    #[must_use]
    pub fn at(&self, r_mm: f32) -> [f32; 3] {
        if !(0.0..=self.r_max_mm).contains(&r_mm) {
            return [0.0; 3];
        }
        let last = self.logs.len() - 1;
        #[allow(clippy::cast_precision_loss, reason = "at most 4,096 nodes")]
        let position = r_mm / self.r_max_mm * last as f32;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the nodes")]
        let h = (position as usize).min(last - 1);
        #[allow(clippy::cast_precision_loss, reason = "at most 4,096 nodes")]
        let w = position - h as f32;
        [0, 1, 2].map(|c| ((1.0 - w) * self.logs[h][c] + w * self.logs[h + 1][c]).exp())
    }
}
