//! Densities that are linear between nodes and constant beyond them: integral, value and inverse.

use crate::btf::angle::sqrt;
use crate::btf::grid::MAX_NODES;

/// Room for the values of all nodes, four at a time.
pub(super) type Values = [[f32; 4]; MAX_NODES as usize / 4];
/// None yet.
pub(super) const ZEROS: Values = [[0.0; 4]; MAX_NODES as usize / 4];
/// Share of all draws that fall anywhere with the same density, so that it is nowhere 0.
const ANYWHERE: f32 = 1.0 / 32.0;

/// A density that is proportional to values at equidistant nodes, but for what falls anywhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    /// At least two, not negative.
    values: &'a [f32],
    /// Distance of two nodes.
    step: f32,
    /// Length of the constant piece before the first node, and of that after the last.
    end: f32,
    /// What is added to all values.
    floor: f32,
    /// Of the values and what is added.
    integral: f32,
}

/// A place on a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drawn {
    /// Length from the beginning of the line.
    pub(super) at: f32,
    /// Share of draws per length there.
    pub(super) density: f32,
}

impl<'a> Line<'a> {
    /// Over the first `count` values, which reach from −`max` to `max` of a line from −`half` to `half`.
    #[inline]
    pub(super) fn new(values: &'a Values, count: u8, max: f32, half: f32) -> Self {
        let values = values.as_flattened().get(..count.into()).unwrap_or(&[]);
        let (step, end) = (2.0 * max / (f32::from(count) - 1.0), half - max);
        let (chunks, rest) = values.as_chunks::<4>();
        let mut sums = [0.0; 4];
        for chunk in chunks {
            for (sum, value) in sums.iter_mut().zip(chunk) {
                *sum += value;
            }
        }
        let [a, b, c, d] = sums;
        let sum = ((a + b) + (c + d)) + rest.iter().sum::<f32>();
        let mut line = Self { values, step, end, floor: 0.0, integral: 0.0 };
        let (first, last) = line.ends();
        let integral = step * (sum - 0.5 * (first + last)) + end * (first + last);
        // Nothing but zeros, as in a hostile file: all places are alike.
        line.integral = if integral > 0.0 { integral * (1.0 / (1.0 - ANYWHERE)) } else { 1.0 };
        line.floor = (line.integral - integral) / (2.0 * half);
        line
    }

    /// First and last value, floor left out.
    #[inline]
    fn ends(&self) -> (f32, f32) {
        match self.values {
            [first, .., last] => (*first, *last),
            _ => (0.0, 0.0),
        }
    }

    /// The place that has the share `part`, 0 to 1, of the density before it. It moves on without jumps as `part` grows.
    #[inline]
    pub(super) fn draw(&self, part: f32) -> Drawn {
        let (first, last) = self.ends();
        let (first, last) = (first + self.floor, last + self.floor);
        let target = part * self.integral;
        let mut rest = target - self.end * first;
        if rest < 0.0 {
            return Drawn { at: target / first, density: first / self.integral };
        }
        let (mut at, half_step) = (self.end, 0.5 * self.step);
        for (low, high) in self.values.iter().zip(self.values.get(1..).unwrap_or(&[])) {
            let share = half_step * (low + high) + self.step * self.floor;
            if rest < share {
                // low u + ½ (high − low) u² = rest / step, in the form that subtracts nothing from nothing.
                let (low, slope, rest) = (low + self.floor, high - low, 2.0 * rest / self.step);
                let value = sqrt(low * low + slope * rest);
                let u = (rest / (low + value)).min(1.0);
                return Drawn { at: at + u * self.step, density: (low + u * slope) / self.integral };
            }
            rest -= share;
            at += self.step;
        }
        Drawn { at: at + (rest / last).min(self.end), density: last / self.integral }
    }

    /// Density at a place, as [`Self::draw`] gives it.
    #[inline]
    pub(super) fn at(&self, place: f32) -> f32 {
        let last = self.values.len().saturating_sub(1);
        #[allow(clippy::cast_precision_loss, reason = "0 to 63")]
        let t = ((place - self.end) / self.step).max(0.0).min(last as f32);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 63")]
        let node = (t as usize).min(last.saturating_sub(1));
        #[allow(clippy::cast_precision_loss, reason = "0 to 63")]
        let weight = t - node as f32;
        let value = match self.values.get(node..) {
            Some([low, high, ..]) => low + weight * (high - low),
            _ => 0.0,
        };
        (value + self.floor) / self.integral
    }
}
