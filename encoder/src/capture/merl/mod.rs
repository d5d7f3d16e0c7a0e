//! Isotropic BRDFs as the MERL database tabulates them (Matusik et al. 2003).
//!
//! A `.binary` file holds three i32, the counts 90, 90 and 180, and then 90 · 90 · 180 f64 for red, as many for green,
//! and for blue, all little-endian: `[channel][θ_h][θ_d][φ_d]`. The half vector of light and view is θ_h off the
//! normal, the light θ_d off the half vector, at azimuth φ_d around it (Rusinkiewicz 1998). θ_h = (i / 90)² 90°, θ_d =
//! i · 1°, φ_d = i · 1° at the beginning of sample i; φ_d ends at 180°, as beyond it light and view have changed
//! places.

mod source;

use std::f64::consts::{FRAC_PI_2, PI};
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};
use memmap2::Mmap;

use crate::error::{Error, Result};
use crate::file::output::write_atomically;

/// Samples in θ_h, θ_d and φ_d.
const COUNTS: [usize; 3] = [90, 90, 180];
/// Samples of a channel.
const SAMPLES: usize = COUNTS[0] * COUNTS[1] * COUNTS[2];
const HEADER_BYTES: usize = 12;
const FILE_BYTES: usize = HEADER_BYTES + 3 * SAMPLES * 8;
/// What samples of red, green and blue are multiplied with.
const SCALE: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];
/// What real files have where nothing was measured.
const UNMEASURED: f64 = -1.0;

/// A tabulated isotropic BRDF on disk, memory-mapped.
///
/// Directions are unit vectors in a frame whose z is the normal. Samples below zero, or not finite, were not measured:
/// they are no part of what is interpolated, and zero by themselves.
#[derive(Debug)]
pub struct Merl {
    path: PathBuf,
    map: Mmap,
}

impl Merl {
    /// Maps a `.binary` file of 34,992,012 bytes.
    ///
    /// # Errors
    /// [`Error::Input`] for other counts or another length.
    pub fn open(path: &Path) -> Result<Self> {
        let file = File::open(path).map_err(|error| Error::input(path, error, "a BRDF (.binary) that can be read"))?;
        // SAFETY: the mapping is read-only. Another process that truncates or rewrites the file meanwhile breaks
        // every reader of maps; `write` replaces files as a whole.
        let map = unsafe { Mmap::map(&file) }
            .map_err(|error| Error::input(path, error, "a BRDF (.binary) that can be mapped"))?;
        let counts: Vec<i32> =
            map.as_chunks().0.iter().take(COUNTS.len()).map(|count| i32::from_le_bytes(*count)).collect();
        if map.len() != FILE_BYTES || counts != [90, 90, 180] {
            let found = format!("{} bytes that begin with the counts {counts:?}", map.len());
            return Err(Error::input(path, found, format!("{FILE_BYTES} bytes, the counts {COUNTS:?}")));
        }
        Ok(Self { path: path.to_owned(), map })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// f_r in sr⁻¹, linear RGB: between the middles of the eight samples around, leaving out those that were not
    /// measured; zero if none was, and below the horizon.
    #[must_use]
    pub fn eval(&self, light: Vec3, view: Vec3) -> [f32; 3] {
        let Some(at) = coordinates(light, view) else {
            return [0.0; 3];
        };
        // φ_d goes round.
        let sides: [[(usize, f64); 2]; 3] = std::array::from_fn(|axis| {
            let (count, from_middle) = (COUNTS[axis], at[axis] - 0.5);
            let last = (count - 1) as f64;
            let from_first =
                if axis == 2 { from_middle.rem_euclid(count as f64) } else { from_middle.clamp(0.0, last) };
            let (index, share) = (floor(from_first, count), from_first.fract());
            let next = if axis == 2 { (index + 1) % count } else { (index + 1).min(count - 1) };
            [(index, 1.0 - share), (next, share)]
        });
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for corner in 0..8 {
            let side = |axis: usize| sides[axis][corner >> axis & 1];
            let weight = side(0).1 * side(1).1 * side(2).1;
            if let Some(sample) = self.sample([side(0).0, side(1).0, side(2).0]).filter(|_| weight > 0.0) {
                total += weight;
                for c in 0..3 {
                    sum[c] += weight * sample[c];
                }
            }
        }
        if total > 0.0 { sum.map(|value| to_f32(value / total)) } else { [0.0; 3] }
    }

    /// Whether no sample was measured.
    fn is_empty(&self) -> bool {
        (0..SAMPLES)
            .all(|at| self.sample([at / (COUNTS[1] * COUNTS[2]), at / COUNTS[2] % COUNTS[1], at % COUNTS[2]]).is_none())
    }

    /// The one sample whose cell the directions are in, as the database's own reader has it; zero if it was not
    /// measured, and below the horizon. In steps, where [`Merl::eval`] is smooth.
    #[must_use]
    pub fn nearest(&self, light: Vec3, view: Vec3) -> [f32; 3] {
        let cell = |at: [f64; 3]| std::array::from_fn(|axis| floor(at[axis], COUNTS[axis]));
        let sample = coordinates(light, view).and_then(|at| self.sample(cell(at)));
        sample.map_or([0.0; 3], |sample| sample.map(to_f32))
    }

    /// A sample in sr⁻¹, `None` if it was not measured.
    fn sample(&self, index: [usize; 3]) -> Option<[f64; 3]> {
        let at = (index[0] * COUNTS[1] + index[1]) * COUNTS[2] + index[2];
        let (values, _) = self.map[HEADER_BYTES..].as_chunks();
        let value = |c: usize| SCALE[c] * f64::from_le_bytes(values[c * SAMPLES + at]);
        let sample = [value(0), value(1), value(2)];
        sample.iter().all(|value| (0.0..=f64::from(f32::MAX)).contains(value)).then_some(sample)
    }

    /// Tabulates a BRDF in sr⁻¹, linear RGB, of a light and a view above the horizon, in the middles of samples. It has
    /// to be isotropic and reciprocal; other ones are seen from where the half vector lies at azimuth 0, and the light
    /// at 0 to 180° around it.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn write(path: &Path, brdf: impl Fn(Vec3, Vec3) -> [f32; 3]) -> Result<()> {
        let mut samples = Vec::with_capacity(SAMPLES);
        for index in 0..SAMPLES {
            let [h, d, p] = [index / (COUNTS[1] * COUNTS[2]), index / COUNTS[2] % COUNTS[1], index % COUNTS[2]];
            let (light, view) = directions([h, d, p].map(|i| i as f64 + 0.5));
            samples.push((light.z > 0.0 && view.z > 0.0).then(|| brdf(light, view)));
        }
        write_atomically(path, |file| {
            for count in [90_i32, 90, 180] {
                file.write_all(&count.to_le_bytes())?;
            }
            for c in 0..3 {
                for sample in &samples {
                    let value = sample.map_or(UNMEASURED, |sample| f64::from(sample[c]) / SCALE[c]);
                    file.write_all(&value.to_le_bytes())?;
                }
            }
            Ok(())
        })
    }
}

#[allow(clippy::cast_possible_truncation, reason = "callers want floats")]
fn to_f32(value: f64) -> f32 {
    value as f32
}

/// The sample that a coordinate lies in.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts saturate; the last sample is the limit"
)]
fn floor(at: f64, count: usize) -> usize {
    (at as usize).min(count - 1)
}

/// Where directions lie in the table, in samples: 0 to 90, 0 to 90 and 0 to 180. `None` below the horizon.
fn coordinates(light: Vec3, view: Vec3) -> Option<[f64; 3]> {
    if light.z <= 0.0 || view.z <= 0.0 {
        return None;
    }
    let (light, view) = (light.as_dvec3(), view.as_dvec3());
    let half = (light + view).normalize_or(DVec3::Z);
    let theta_h = half.truncate().length().atan2(half.z);
    // The light in a frame whose z is the half vector, and whose x leans from the normal to it.
    let (sin_phi, cos_phi) = half.y.atan2(half.x).sin_cos();
    let (sin, cos) = theta_h.sin_cos();
    let (x, y) = (DVec3::new(cos_phi * cos, sin_phi * cos, -sin), DVec3::new(-sin_phi, cos_phi, 0.0));
    let light = DVec3::new(light.dot(x), light.dot(y), light.dot(half));
    let theta_d = light.truncate().length().atan2(light.z);
    let phi_d = light.y.atan2(light.x).rem_euclid(PI);
    Some([90.0 * (theta_h / FRAC_PI_2).sqrt(), 90.0 * theta_d / FRAC_PI_2, 180.0 * phi_d / PI])
}

/// Light and view of coordinates, with the half vector at azimuth 0: the inverse of [`coordinates`].
fn directions([h, d, p]: [f64; 3]) -> (Vec3, Vec3) {
    let (sin_h, cos_h) = ((h / 90.0).powi(2) * FRAC_PI_2).sin_cos();
    let (sin_d, cos_d) = (d / 90.0 * FRAC_PI_2).sin_cos();
    let (sin_p, cos_p) = (p / 180.0 * PI).sin_cos();
    let (x, half) = (DVec3::new(cos_h, 0.0, -sin_h), DVec3::new(sin_h, 0.0, cos_h));
    let across = sin_d * (cos_p * x + sin_p * DVec3::Y);
    ((cos_d * half + across).as_vec3(), (cos_d * half - across).as_vec3())
}

#[cfg(test)]
mod tests {
    use std::fs::OpenOptions;
    use std::io::{Seek, SeekFrom};

    use super::*;
    use crate::synthetic::unit;

    /// Coloured Lambert below isotropic GGX of roughness α = 0.2 with F = 0.05 and masking by Smith.
    pub(super) fn plastic(light: Vec3, view: Vec3) -> [f32; 3] {
        let a2 = 0.2_f32 * 0.2;
        let half = (light + view).normalize();
        let d = a2 / (std::f32::consts::PI * (half.z * half.z * (a2 - 1.0) + 1.0).powi(2));
        let mask = |w: Vec3| w.z + (a2 + (1.0 - a2) * w.z * w.z).sqrt();
        let lobe = 0.05 * d / (mask(light) * mask(view));
        [0.6, 0.3, 0.1].map(|rd| rd / std::f32::consts::PI + lobe)
    }

    /// Pairs up to 80° off the normal, half of them near to mirroring each other.
    pub(super) fn pairs(count: u32) -> impl Iterator<Item = (Vec3, Vec3)> {
        let direction = |n: u32| {
            let (theta, phi) = (80.0_f32.to_radians() * unit(n), std::f32::consts::TAU * unit(n + 1));
            Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
        };
        (0..count).map(move |n| {
            let (light, other) = (direction(4 * n), direction(4 * n + 2));
            let near = (Vec3::new(-light.x, -light.y, light.z) + 0.3 * (other - Vec3::Z)).normalize();
            (light, if n % 2 == 0 || near.z < 0.2 { other } else { near })
        })
    }

    #[test]
    fn coordinates_and_directions_are_inverse() {
        for n in 0..2_000 {
            // Of half vectors close to the normal nobody knows the azimuth.
            let at = [3.0 + 87.0 * unit(3 * n), 90.0 * unit(3 * n + 1), 180.0 * unit(3 * n + 2)].map(f64::from);
            let (light, view) = directions(at);
            assert!((light.length() - 1.0).abs() < 1e-6 && (view.length() - 1.0).abs() < 1e-6, "{at:?}");
            let Some(back) = coordinates(light, view) else {
                continue;
            };
            let turned = |w: Vec3| Vec3::new(0.6 * w.x - 0.8 * w.y, 0.8 * w.x + 0.6 * w.y, w.z);
            let others = [coordinates(turned(light), turned(view)), coordinates(view, light)];
            for found in [back].into_iter().chain(others.into_iter().flatten()) {
                // φ_d is nowhere in particular near θ_d = 0, and goes round.
                let error = [0, 1, 2].map(|axis| (found[axis] - at[axis]).abs());
                let round = error[2].min(180.0 - error[2]) * (at[1] / 57.3).sin();
                assert!(error[0] < 0.02 && error[1] < 0.02 && round < 0.02, "{found:?} for {at:?}");
            }
        }
    }

    /// Written once: files are 35 MB.
    #[test]
    fn files_are_read_as_they_were_written() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("plastic.binary");
        Merl::write(&path, plastic).unwrap();
        assert_eq!(std::fs::metadata(&path).unwrap().len(), 34_992_012);
        let merl = Merl::open(&path).unwrap();
        assert_eq!(merl.path(), path);
        let (mut smooth, mut steps) = (0.0_f32, 0.0_f32);
        for (light, view) in pairs(20_000) {
            let expected = plastic(light, view);
            for (found, error) in [(merl.eval(light, view), &mut smooth), (merl.nearest(light, view), &mut steps)] {
                for c in 0..3 {
                    *error = error.max((found[c] / expected[c] - 1.0).abs());
                }
            }
            let back = merl.eval(view, light);
            assert!((0..3).all(|c| (back[c] - merl.eval(light, view)[c]).abs() <= 1e-3 * back[c]), "{light} {view}");
        }
        assert!(smooth < 0.01, "relative error between samples: {smooth}");
        assert!(steps < 0.12, "relative error in steps: {steps}");
        for (light, view) in [(-Vec3::Z, Vec3::Z), (Vec3::X, Vec3::Z), (Vec3::Z, Vec3::NEG_Y)] {
            assert_eq!((merl.eval(light, view), merl.nearest(light, view)), ([0.0; 3], [0.0; 3]), "{light} {view}");
        }
        drop(merl);

        // One sample: θ_h in its first, θ_d of 30°, φ_d of 45°. Where it lies is written out.
        let (light, view) = directions([0.5, 30.5, 45.5]);
        let mut file = OpenOptions::new().write(true).open(&path).unwrap();
        let mut put = |value: f64| {
            for c in 0..3 {
                file.seek(SeekFrom::Start(12 + 8 * (1_458_000 * c + 180 * 30 + 45))).unwrap();
                file.write_all(&value.to_le_bytes()).unwrap();
            }
        };
        put(1500.0);
        let found = Merl::open(&path).unwrap().nearest(light, view);
        assert!((0..3).all(|c| (found[c] - [1.0, 1.15, 1.66][c]).abs() < 1e-6), "{found:?}");
        for unmeasured in [-1.0, f64::NAN, f64::INFINITY, 1e300] {
            put(unmeasured);
            let merl = Merl::open(&path).unwrap();
            assert_eq!(merl.nearest(light, view), [0.0; 3]);
            // Next to it, from what is around.
            let (light, view) = directions([0.5, 30.7, 45.7]);
            let (found, expected) = (merl.eval(light, view), plastic(light, view));
            assert!((0..3).all(|c| (found[c] / expected[c] - 1.0).abs() < 0.02), "{found:?} for {expected:?}");
        }

        // Counts, then lengths.
        file.seek(SeekFrom::Start(8)).unwrap();
        file.write_all(&360_i32.to_le_bytes()).unwrap();
        let refusal = || Merl::open(&path).unwrap_err().to_string();
        let expected = "expected 34992012 bytes, the counts [90, 90, 180]";
        let message = refusal();
        assert!(message.contains("counts [90, 90, 360]") && message.contains(expected), "{message}");
        for len in [34_992_011, 34_992_013, 13, 11, 4, 0] {
            file.set_len(len).unwrap();
            let message = refusal();
            assert!(message.contains(&format!(": {len} bytes")) && message.contains(expected), "{message}");
        }
        assert!(Merl::open(&place.path().join("nothing.binary")).is_err());
    }
}
