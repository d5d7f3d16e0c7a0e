//! Captures of heterogeneous slabs, photon packet by photon packet: no diffusion is assumed.
//!
//! Every pixel of a [`Slab`] in turn is lit by a beam straight down, as wide as the pixel and of one watt within the slab; packets
//! scatter alike in all directions (σ_s' stands for σ_s and g), are reflected by Fresnel at both faces, and are counted by the pixel
//! that they leave the upper face at.

use super::beam::{Beam, signed};
use crate::capture::neighbour;
use crate::math::parallel;
use crate::progress::Progress;
use crate::simulate::diffusion::Slab;

/// Packets for each pixel and channel where nothing else is asked for.
pub const PACKETS: u64 = 100_000;
/// Packets for a pixel and channel, at most.
pub const MAX_PACKETS: u64 = 1 << 31;

/// Passes over all pixels: after each, a run can be stopped.
const PASSES: u64 = 8;

/// How much is traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Photon packets for each pixel and channel.
    pub packets: u64,
    /// Seed of the random numbers: the same seed gives the same result, to the last bit, on any number of threads.
    pub seed: u64,
}

/// What a camera and a projector would see of a slab.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Windows of all pixels, `[y][x][dy][dx][rgb]` in mm⁻², as [`Slab::measure`] has them.
    pub windows: Vec<f32>,
    /// Share of the light leaving the upper face that leaves within the window, mean over pixels.
    pub window_share: f64,
    /// Packets traced for each pixel and channel: all, or those until it was stopped.
    pub packets: u64,
}

/// Measures the windows of all pixels. Where `progress` says stop, an eighth of the packets is traced, or more.
#[must_use]
pub fn measure(slab: &Slab<'_>, settings: Settings, progress: &dyn Progress) -> Measured {
    let d = 2 * slab.radius + 1;
    let pixels = slab.map.media.len();
    let passes = PASSES.min(settings.packets);
    progress.begin("tracing photons", pixels as u64 * passes);
    let mut windows = vec![0.0_f32; pixels * d * d * 3];
    let mut outside = vec![0.0_f64; pixels];
    let (mut first, mut pass) = (0, 0);
    while pass < passes && (pass == 0 || !progress.stopped()) {
        pass += 1;
        let end = settings.packets * pass / passes;
        let more = parallel::map_chunks(&mut windows, d * d * 3, |pixel, window| {
            let mut outside = 0.0;
            for c in 0..3 {
                let traced = Beam::new(slab, settings.seed, pixel, c).trace(first, end);
                for (place, sum) in traced.window.iter().enumerate() {
                    #[allow(clippy::cast_possible_truncation, reason = "captures are f32")]
                    let sum = *sum as f32;
                    window[place * 3 + c] += sum;
                }
                outside += traced.outside;
            }
            progress.advance(1);
            outside
        });
        outside.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        first = end;
    }
    #[allow(clippy::cast_precision_loss, reason = "far below 2^53")]
    let traced = first as f64;
    let rd_per_watt = 1.0 / (traced * slab.pitch_mm * slab.pitch_mm);
    let mut share = 0.0;
    for (pixel, (window, outside)) in windows.chunks_mut(d * d * 3).zip(outside).enumerate() {
        let within: f64 = window.iter().copied().map(f64::from).sum();
        share += within / (within + outside).max(f64::MIN_POSITIVE);
        let from = [pixel % slab.map.size[0], pixel / slab.map.size[0]];
        for (place, rgb) in window.chunks_mut(3).enumerate() {
            let step = [place % d, place / d].map(|k| signed(k) - signed(slab.radius));
            let inside = neighbour(slab.addressing, slab.map.size, from, step).is_some();
            for value in rgb {
                #[allow(clippy::cast_possible_truncation, reason = "captures are f32")]
                let rd = (f64::from(*value) * rd_per_watt) as f32;
                *value = if inside { rd } else { f32::NAN };
            }
        }
    }
    #[allow(clippy::cast_precision_loss, reason = "pixels fit in 2⁵³")]
    let pixels = pixels as f64;
    Measured { windows, window_share: share / pixels, packets: first }
}

#[cfg(test)]
mod tests {
    use subsurf_decoder::bssrdf::Addressing;

    use super::*;
    use crate::simulate::diffusion::{Medium, MediumMap};

    #[test]
    fn threads_change_nothing() {
        let [a, b] = ["skin1", "marble"].map(|name| Medium::measured(name).unwrap());
        let map = MediumMap { size: [2, 2], media: vec![a, b, b, a] };
        let addressing = Addressing::Repeat;
        let slab = Slab { map: &map, addressing, pitch_mm: 0.5, radius: 2, thickness_mm: 1.0, eta: 1.4, refine: 1.0 };
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| measure(&slab, Settings { packets: 1_000, seed: 1 }, &()))
        };
        assert!(on(1) == on(3), "captures hang on the number of threads");
    }
}
