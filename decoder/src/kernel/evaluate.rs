//! Values of kernel and profile.

use super::reader::{Kernel, RGB};
use crate::container::index::row_major;

impl Kernel<'_> {
    /// Sign s_t of a term for each channel, −1 or 1; zeros out of range.
    #[must_use]
    pub fn sign(&self, term: usize) -> [f32; 3] {
        self.header().sign(term)
    }

    /// Weights w_ti of tap `tap`, counted from the centre to one side, for each channel; zeros out of range.
    #[must_use]
    pub fn weight(&self, term: usize, tap: usize) -> [f32; 3] {
        let side = self.header().side();
        if term >= self.header().terms.into() || tap >= side {
            return [0.0; 3];
        }
        self.weights().rgb_at(row_major(row_major(term, side, tap), RGB, 0))
    }

    /// Reflectance ||R_d||_1 for each channel, 0 to 1: what even light becomes on a plane.
    #[must_use]
    pub fn reflectance(&self) -> [f32; 3] {
        self.tail().rgb_at(0)
    }

    /// What the kernel makes of even light, Σ_t s_t (Σ_i w_ti)², for each channel: the reflectance within 1/1024.
    #[must_use]
    pub fn energy(&self) -> [f32; 3] {
        let mut energy = [0.0; 3];
        for term in 0..self.header().terms.into() {
            let taps = (0..self.header().side()).map(|tap| self.weight(term, tap));
            add_term(&mut energy, self.sign(term), taps);
        }
        energy
    }

    /// Tail T(d) = ∫_d^∞ R_d(u) 2π u du for each channel, 0 to the reflectance; `d_mm` in mm, at least 0. It is what comes through a plate
    /// of thickness d (Jimenez et al. 2010, for any profile). Between nodes it is linear in √d; 0 from the radius on, and for NaN.
    #[must_use]
    pub fn tail_at(&self, d_mm: f32) -> [f32; 3] {
        let place = libm::sqrtf(d_mm.max(0.0) / self.header().radius_mm);
        if d_mm.is_nan() || place >= 1.0 {
            return [0.0; 3];
        }
        let intervals = self.header().tail_nodes.saturating_sub(1);
        let at = place * f32::from(intervals);
        let node = libm::floorf(at);
        let share = at - node;
        let low = self.tail().rgb_at(row_major(whole(node), RGB, 0));
        let high = self.tail().rgb_at(row_major(whole(node).wrapping_add(1), RGB, 0));
        let mut tail = low;
        for (low, high) in tail.iter_mut().zip(high) {
            *low += share * (high - *low);
        }
        tail
    }

    /// Profile R_d(r) in mm⁻² for each channel, `r_mm` in mm, at least 0: the mean over the ring between the two nodes of the tail around r.
    /// 0 from the radius on, and for NaN.
    #[must_use]
    pub fn rd(&self, r_mm: f32) -> [f32; 3] {
        let radius = self.header().radius_mm;
        let place = libm::sqrtf(r_mm.max(0.0) / radius);
        if r_mm.is_nan() || place >= 1.0 {
            return [0.0; 3];
        }
        let intervals = f32::from(self.header().tail_nodes.saturating_sub(1));
        let node = libm::floorf(place * intervals);
        let [inner, outer] = [node, node + 1.0].map(|node| radius * (node / intervals) * (node / intervals));
        // Squares of radii differ by (outer − inner) (outer + inner); small radii do not vanish so.
        let area = core::f32::consts::PI * (outer - inner) * (outer + inner);
        let low = self.tail().rgb_at(row_major(whole(node), RGB, 0));
        let high = self.tail().rgb_at(row_major(whole(node).wrapping_add(1), RGB, 0));
        let mut rd = low;
        for (rd, high) in rd.iter_mut().zip(high) {
            *rd = if area > 0.0 { (*rd - high) / area } else { 0.0 };
        }
        rd
    }
}

/// Adds s (w_0 + 2 Σ_i w_i)² of a term, for each channel, from its weights from the centre on.
pub(super) fn add_term(energy: &mut [f32; 3], sign: [f32; 3], taps: impl Iterator<Item = [f32; 3]>) {
    let mut sums = [0.0; 3];
    for (tap, weights) in taps.enumerate() {
        let times = if tap == 0 { 1.0 } else { 2.0 };
        for (sum, w) in sums.iter_mut().zip(weights) {
            *sum += times * w;
        }
    }
    for ((energy, sum), sign) in energy.iter_mut().zip(sums).zip(sign) {
        *energy += sign * sum * sum;
    }
}

/// A small number without its fraction.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a node of at most 1,024")]
fn whole(node: f32) -> usize {
    node as usize
}
