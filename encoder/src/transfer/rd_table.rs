//! R_d(r) in a table that is quick to look up.

use crate::kernel::profile::{Profile, Radial};

/// Nodes of the tail T(d); files have them, so that what was precomputed can be computed again.
const NODES: usize = 256;

/// Diffuse reflectance profile of three channels by the nodes of its tail, as files of transfer have it.
///
/// T(d) = ∫_d^∞ R_d(u) 2π u du at d_k = radius (k / (m − 1))². R_d is the mean over the ring between two nodes at the ring's middle
/// in √r, and linear in √r between middles.
#[derive(Clone, Debug, PartialEq)]
pub struct RdTable {
    /// Radius in mm beyond which R_d is 0.
    pub radius_mm: f32,
    /// T(d_k) `[k][rgb]`, from the reflectance down to 0.
    pub tail: Vec<[f32; 3]>,
    /// R_d of the rings in mm⁻².
    rings: Vec<[f32; 3]>,
}

impl RdTable {
    /// Table of a profile, each channel as far as it reaches but for a thousandth of its light.
    ///
    /// # Errors
    /// [`Error::Request`](crate::Error) for profiles that reflect nothing, or more than all light, and for radii that files do not have.
    pub fn of(profile: &Profile) -> crate::Result<Self> {
        let profile = profile.limited()?;
        let radius = profile.channels.iter().map(Radial::radius_mm).fold(0.0, f64::max);
        let node = |k: usize| {
            let d = radius * (k as f64 / (NODES - 1) as f64).powi(2);
            std::array::from_fn(|c| if k == NODES - 1 { 0.0 } else { single(profile.channels[c].tail(d)) })
        };
        Ok(Self::of_tail(single(radius), (0..NODES).map(node).collect()))
    }

    /// Table of the nodes of a tail, at least two.
    #[must_use]
    pub fn of_tail(radius_mm: f32, tail: Vec<[f32; 3]>) -> Self {
        let last = (tail.len() - 1) as f64;
        let edge = |k: usize| f64::from(radius_mm) * (k as f64 / last).powi(2);
        let ring = |k: usize| {
            let area = std::f64::consts::PI * (edge(k + 1).powi(2) - edge(k).powi(2));
            std::array::from_fn(|c| single(f64::from(tail[k][c] - tail[k + 1][c]) / area))
        };
        let rings = (0..tail.len() - 1).map(ring).collect();
        Self { radius_mm, tail, rings }
    }

    /// The mean of the three channels, in all of them.
    #[must_use]
    pub fn grey(&self) -> Self {
        let mean = |rgb: &[f32; 3]| [rgb.iter().sum::<f32>() / 3.0; 3];
        let [tail, rings] = [&self.tail, &self.rings].map(|of| of.iter().map(mean).collect());
        Self { radius_mm: self.radius_mm, tail, rings }
    }

    /// Reflectance T(0) `[rgb]`: what even light becomes on a plane.
    #[must_use]
    pub fn reflectance(&self) -> [f32; 3] {
        self.tail[0]
    }

    /// R_d in mm⁻² at a distance whose square is `r2_mm2`.
    #[inline]
    pub(super) fn at_squared(&self, r2_mm2: f32) -> [f32; 3] {
        let place = (r2_mm2.sqrt() / self.radius_mm).sqrt() * self.rings.len() as f32 - 0.5;
        if place >= self.rings.len() as f32 - 0.5 {
            return [0.0; 3];
        }
        // Level up to the middle of the innermost ring, and from that of the last on.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a ring")]
        let low = place.max(0.0) as usize;
        let [low, high] = [self.rings[low], self.rings[(low + 1).min(self.rings.len() - 1)]];
        let share = place.max(0.0).fract();
        std::array::from_fn(|c| low[c] + share * (high[c] - low[c]))
    }

    /// T(d) at `d_mm`, linear in √d between nodes.
    pub(super) fn tail_at(&self, d_mm: f32) -> [f32; 3] {
        let place = (d_mm / self.radius_mm).sqrt() * self.rings.len() as f32;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let low = place as usize;
        if low >= self.rings.len() {
            return [0.0; 3];
        }
        std::array::from_fn(|c| self.tail[low][c] + place.fract() * (self.tail[low + 1][c] - self.tail[low][c]))
    }

    /// Radius in mm within which half of the light leaves, of the channel where that is least.
    pub(super) fn half_radius_mm(&self) -> f32 {
        let is_beyond = |tail: &[f32; 3]| (0..3).any(|c| 2.0 * tail[c] <= self.tail[0][c]);
        let node = self.tail.iter().position(is_beyond).unwrap_or(0);
        self.radius_mm * (node as f32 / self.rings.len() as f32).powi(2)
    }
}

/// In single precision, as files have it.
#[allow(clippy::cast_possible_truncation, reason = "rounded, as files have it")]
pub(super) fn single(value: f64) -> f32 {
    value as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::diffusion::Medium;

    #[test]
    fn is_the_profile() {
        let profile = Profile::dipole(&Medium::measured("marble").unwrap(), 1.5).unwrap();
        let table = RdTable::of(&profile).unwrap();
        for r in [0.05_f32, 0.3, 1.0, 4.0, 10.0] {
            let found = table.at_squared(r * r);
            for c in 0..3 {
                let expected = single(profile.channels[c].at(r.into()));
                assert!((found[c] - expected).abs() < 0.03 * expected, "{r} mm: {} of {expected}", found[c]);
            }
        }
        assert_eq!(table.at_squared(table.radius_mm * table.radius_mm), [0.0; 3]);
        // ∫ R_d 2π r dr is the reflectance.
        let step = table.radius_mm / 1e5;
        let middle = |k: u32| (k as f32 + 0.5) * step;
        let energy: f32 = (0..100_000)
            .map(|k| table.at_squared(middle(k).powi(2))[0] * std::f32::consts::TAU * middle(k) * step)
            .sum();
        let [red, ..] = table.reflectance();
        assert!((energy - red).abs() < 0.01 * red, "{energy} of {red}");
    }
}
