//! Densities that are piecewise linear between nodes and constant beyond them: integral, value and inverse.

use crate::btf::angle::sqrt;
use crate::btf::grid::MAX_NODES;

/// Room for the values of all nodes, four at a time.
type Values = [[f32; 4]; MAX_NODES as usize / 4];
const ZEROS: Values = [[0.0; 4]; MAX_NODES as usize / 4];
/// Share of all draws that fall anywhere with the same density, so that it is nowhere 0.
const ANYWHERE: f32 = 1.0 / 32.0;
/// Integral above which its reciprocal is finite and its shares are normal numbers; those of files are at least 2⁻⁷² but where a weight is next to none.
const LEAST: f32 = f32::MIN_POSITIVE / f32::EPSILON;

/// Axis with equidistant nodes, and pieces beyond the outer ones.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    /// Number of nodes, at least two.
    count: u8,
    /// Distance of two nodes.
    step: f32,
    /// 1 / `step`.
    per_length: f32,
    /// Length of the piece before the first node, and of that after the last.
    end: f32,
    /// Density that is the same everywhere: 1 / length of the axis.
    even: f32,
}

impl Axis {
    /// From −`half` to `half` with `count` nodes from −`max` to `max`.
    pub(super) fn new(count: u8, max: f32, half: f32) -> Self {
        let pieces = f32::from(count) - 1.0;
        Self { count, step: 2.0 * max / pieces, per_length: pieces / (2.0 * max), end: half - max, even: 0.5 / half }
    }
}

/// Density over an axis, in proportion to values at its nodes but for draws that fall anywhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct PiecewiseLinear<'a> {
    axis: &'a Axis,
    /// Values at the nodes.
    values: Values,
    /// Number that is added to all values.
    floor: f32,
    /// Integral of the values and what is added.
    integral: f32,
    /// 1 / `integral`.
    per_integral: f32,
}

/// Place on an axis that was drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drawn {
    /// The node before it.
    pub(super) node: u32,
    /// Weight of the next, 0 to 1.
    pub(super) weight: f32,
    /// Length from the beginning of the axis.
    pub(super) at: f32,
    /// Share of draws per length there.
    pub(super) density: f32,
}

impl<'a> PiecewiseLinear<'a> {
    /// Over an axis, before there are values.
    #[inline]
    pub(super) fn over(axis: &'a Axis) -> Self {
        Self { axis, values: ZEROS, floor: axis.even, integral: 1.0, per_integral: 1.0 }
    }

    /// Room for the values of four nodes at a time, the last of which may be more than there are.
    #[inline]
    pub(super) fn fours(&mut self) -> &mut [[f32; 4]] {
        self.values.get_mut(..usize::from(self.axis.count).div_ceil(4)).unwrap_or(&mut [])
    }

    /// Integrates the values. None of them is negative.
    #[inline]
    pub(super) fn integrate(&mut self) {
        let nodes = self.nodes();
        let (chunks, rest) = nodes.as_chunks::<4>();
        let mut sums = [0.0; 4];
        for chunk in chunks {
            for (sum, value) in sums.iter_mut().zip(chunk) {
                *sum += value;
            }
        }
        let [a, b, c, d] = sums;
        let sum = ((a + b) + (c + d)) + rest.iter().sum::<f32>();
        let (first, last) = ends(nodes);
        let integral = self.axis.step * (sum - 0.5 * (first + last)) + self.axis.end * (first + last);
        const REST: f32 = 1.0 - ANYWHERE;
        // Nothing but zeros, as in a hostile file, or what has no normal shares: all places are alike.
        let (all, floor) =
            if integral > LEAST { (integral * (1.0 / REST), integral * (ANYWHERE / REST)) } else { (1.0, 1.0) };
        (self.integral, self.per_integral, self.floor) = (all, 1.0 / all, floor * self.axis.even);
    }

    #[inline]
    fn nodes(&self) -> &[f32] {
        self.values.as_flattened().get(..self.axis.count.into()).unwrap_or(&[])
    }

    /// The place that has the share `part`, 0 to 1, of the density before it. It moves on without jumps as `part` grows.
    #[inline]
    pub(super) fn draw(&self, part: f32) -> Drawn {
        let nodes = self.nodes();
        let (first, last) = ends(nodes);
        let target = part * self.integral;
        let rest = target - self.axis.end * (first + self.floor);
        if rest < 0.0 {
            let low = first + self.floor;
            return Drawn { node: 0, weight: 0.0, at: target / low, density: low * self.per_integral };
        }
        // To the last node that does not lie beyond it. The search goes on to the end: where to stop would be guessed wrong.
        let (half_step, of_floor) = (0.5 * self.axis.step, self.axis.step * self.floor);
        let (mut left, mut least, mut beyond) = (rest, rest.to_bits(), 0_u32);
        for (low, high) in nodes.iter().zip(nodes.get(1..).unwrap_or(&[])) {
            left -= half_step * (low + high) + of_floor;
            // What is left only falls, and as bits, negative numbers are larger than all others.
            least = least.min(left.to_bits());
            beyond = beyond.wrapping_add(left.to_bits() >> 31);
        }
        let rest = f32::from_bits(least);
        let (pieces, final_cell) =
            (u32::from(self.axis.count).wrapping_sub(1), u32::from(self.axis.count).wrapping_sub(2));
        let passed = pieces.wrapping_sub(beyond);
        let node = passed.min(final_cell);
        #[allow(clippy::cast_precision_loss, reason = "0 to 62")]
        let start = self.axis.end + node as f32 * self.axis.step;
        if passed > final_cell {
            let last = last + self.floor;
            let at = start + self.axis.step + (rest / last).min(self.axis.end);
            return Drawn { node, weight: 1.0, at, density: last * self.per_integral };
        }
        let (low, high) = pair(nodes, node);
        // low u + ½ (high − low) u² = rest / step, in the form that subtracts nothing from nothing; of an integral of 1, so
        // that squares stay within range.
        let [low, slope, rest] =
            [low + self.floor, high - low, 2.0 * self.axis.per_length * rest].map(|x| x * self.per_integral);
        let weight = (rest / (low + sqrt(low * low + slope * rest))).min(1.0);
        Drawn { node, weight, at: start + weight * self.axis.step, density: low + weight * slope }
    }

    /// Density at a place, as [`Self::draw`] gives it.
    #[inline]
    pub(super) fn at(&self, place: f32) -> f32 {
        let last = u32::from(self.axis.count).wrapping_sub(1);
        #[allow(clippy::cast_precision_loss, reason = "0 to 63")]
        let t = ((place - self.axis.end) * self.axis.per_length).max(0.0).min(last as f32);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 63")]
        let node = (t as u32).min(last.wrapping_sub(1));
        let (low, high) = pair(self.nodes(), node);
        #[allow(clippy::cast_precision_loss, reason = "0 to 63")]
        let weight = t - node as f32;
        (low + weight * (high - low) + self.floor) * self.per_integral
    }
}

/// First and last value.
#[inline]
fn ends(nodes: &[f32]) -> (f32, f32) {
    match nodes {
        [first, .., last] => (*first, *last),
        _ => (0.0, 0.0),
    }
}

/// The values at a node and the next.
#[inline]
fn pair(nodes: &[f32], node: u32) -> (f32, f32) {
    match nodes.get(node as usize..) {
        Some([low, high, ..]) => (*low, *high),
        _ => (0.0, 0.0),
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::vec::Vec;

    #[test]
    fn densities_are_finite_and_above_0_whatever_the_values() {
        let axis = Axis::new(3, 0.9, 1.0);
        for value in [0.0, f32::from_bits(1), 1e-40, f32::MIN_POSITIVE, LEAST, 1e-20, 1.0, 1e30] {
            for values in [[value, 0.0, 0.0], [0.0, value, 0.0], [0.0, 0.0, value], [value; 3]] {
                let mut density = PiecewiseLinear::over(&axis);
                for (node, value) in density.values.as_flattened_mut().iter_mut().zip(values) {
                    *node = value;
                }
                density.integrate();
                for part in [0.0, f32::from_bits(1), 1e-20, 0.3, 0.5, 1.0] {
                    let drawn = density.draw(part);
                    assert!(drawn.density.is_normal() && drawn.density > 0.0, "{values:?}, {part}: {drawn:?}");
                    assert!((0.0..=2.0).contains(&drawn.at), "{values:?}, {part}: {drawn:?}");
                    let at = density.at(drawn.at);
                    assert!((at / drawn.density - 1.0).abs() < 1e-3, "{values:?}, {part}: {drawn:?}, {at}");
                }
            }
        }
    }

    /// Share of the density before a place: pieces are linear.
    fn share(density: &PiecewiseLinear<'_>, place: f32) -> f64 {
        let axis = density.axis;
        let nodes = (0..axis.count).map(|node| axis.end + f32::from(node) * axis.step);
        let ends: Vec<f32> = nodes.chain([2.0 * axis.end + (f32::from(axis.count) - 1.0) * axis.step]).collect();
        let (mut start, mut sum) = (0.0_f32, 0.0);
        for end in ends {
            let end = end.min(place);
            sum += 0.5 * f64::from(density.at(start) + density.at(end)) * f64::from((end - start).max(0.0));
            start = end;
        }
        sum
    }

    #[test]
    fn places_have_the_share_that_was_drawn_before_them() {
        let axis = Axis::new(5, 0.7, 1.0);
        for values in [[1.0, 2.0, 0.5, 0.0, 3.0], [4.0, 0.0, 0.0, 1.0, 0.01], [1e-12, 3e-12, 0.0, 1e-12, 2e-12]] {
            let mut density = PiecewiseLinear::over(&axis);
            density.values.as_flattened_mut().iter_mut().zip(values).for_each(|(node, value)| *node = value);
            density.integrate();
            assert!((share(&density, 2.0) - 1.0).abs() < 2e-6, "{values:?}: all of it");
            for part in (0..=1000_u16).map(|k| f32::from(k) / 1000.0) {
                let drawn = density.draw(part);
                let found = share(&density, drawn.at);
                assert!((found - f64::from(part)).abs() < 5e-6, "{values:?}: {found}, not {part}, {drawn:?}");
            }
        }
    }
}
