//! What a camera adds to a simulated capture: shot noise, and a floor below which it sees nothing.

use rand::SeedableRng;
use rand_distr::{Distribution, Normal, Poisson};
use rand_pcg::Pcg64;

/// A camera that counts photons.
#[derive(Clone, Copy, Debug)]
pub struct Sensor {
    /// Photons that a pixel counts where all light of the lit pixel leaves, Rd · pitch² = 1.
    pub photons: f64,
    /// Seed of the noise.
    pub seed: u64,
}

/// Standard deviation of the read-out, in photons.
const READ_NOISE: f64 = 2.0;
/// Counts below this many standard deviations of the read-out are taken for nothing.
const FLOOR: f64 = 3.0;

impl Sensor {
    /// Replaces Rd in mm⁻² by what the camera would report; what drowns in the read-out becomes 0, not measured.
    ///
    /// `pixel` is the lit pixel's number, so that results do not depend on the order of work.
    pub(super) fn expose(&self, pixel: usize, pitch_mm: f64, window: &mut [f32]) {
        let mut rng = Pcg64::new(u128::from(self.seed), pixel as u128);
        // Nearby streams of this generator start alike.
        let mut rng = Pcg64::from_rng(&mut rng);
        let read_out = Normal::new(0.0, READ_NOISE).expect("a positive deviation");
        let photons_per_rd = self.photons * pitch_mm * pitch_mm;
        for rd in window.iter_mut().filter(|rd| rd.is_finite()) {
            let expected = f64::from(*rd) * photons_per_rd;
            let counted = Poisson::new(expected).map_or(0.0, |shot| shot.sample(&mut rng));
            let read = counted + read_out.sample(&mut rng);
            #[allow(clippy::cast_possible_truncation, reason = "captures are f32")]
            let measured = (read / photons_per_rd) as f32;
            *rd = if read < FLOOR * READ_NOISE { 0.0 } else { measured };
        }
    }
}
