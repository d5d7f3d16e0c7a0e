//! Coordinates on a grid: between which nodes of an axis a value falls, and how near to each.

/// Coordinate on one axis, for linear interpolation between two nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LerpCoord {
    /// Numbers of the two nodes.
    pub nodes: [u32; 2],
    /// Weight of the second, 0 to 1.
    pub weight: f32,
}

impl LerpCoord {
    /// Weights of both nodes.
    #[must_use]
    pub fn weights(self) -> [f32; 2] {
        [1.0 - self.weight, self.weight]
    }

    /// `t` in nodes from the first of `count`, at least two; clamped to them.
    #[inline]
    pub(super) fn on_line(t: f32, count: u8) -> Self {
        let last = f32::from(count) - 1.0;
        let (first, weight) = split(t, last);
        Self { nodes: [first, first.wrapping_add(1)], weight }
    }

    /// `value` among `count` nodes from −`max` to `max`.
    #[inline]
    pub(super) fn around(value: f32, max: f32, count: u8) -> Self {
        let middle = 0.5 * (f32::from(count) - 1.0);
        Self::on_line(value * (middle / max) + middle, count)
    }

    /// `t` turns, 0 to 1, on a ring of `count` nodes.
    #[inline]
    pub(super) fn on_ring(t: f32, count: u8) -> Self {
        let count = u32::from(count);
        #[allow(clippy::cast_precision_loss, reason = "at most 64")]
        let nodes = count as f32;
        let (first, weight) = split(t * nodes, nodes);
        let next = first.wrapping_add(1);
        Self { nodes: [first, if next == count { 0 } else { next }], weight }
    }
}

/// Integer part and fraction of a number that is clamped to 0 to `end`; at `end`, the fraction is 1. NaN is 0.
///
/// Where f32 have no room for a fraction, adding rounds: half an `as` that saturates.
#[inline]
fn split(t: f32, end: f32) -> (u32, f32) {
    /// Integers to 2²² on both sides are in the lowest bits.
    const WHOLE: f32 = 12_582_912.0;
    let t = t.max(0.0).min(end);
    let rounded = (t - 0.5).min(end - 1.0) + WHOLE;
    (rounded.to_bits() & 0xFF, t - (rounded - WHOLE))
}

/// Coordinates of a pair of directions, light and view, on the four axes of a grid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridCoord {
    /// Azimuth φ_v of the view.
    pub phi: LerpCoord,
    /// Angle θ_v of the view from the normal.
    pub theta: LerpCoord,
    /// α, the slice of the light.
    pub alpha: LerpCoord,
    /// sin β, the position of the light on its slice.
    pub beta: LerpCoord,
    /// Factor of all values: 1 where lights were measured, less below, 0 below the horizon.
    pub fade: f32,
}

impl GridCoord {
    /// The first of the two nodes of α.
    #[inline]
    pub(crate) fn first_alpha(&self) -> u32 {
        let [first, _] = self.alpha.nodes;
        first
    }

    /// The first of the two nodes of sin β.
    #[inline]
    pub(crate) fn first_beta(&self) -> u32 {
        let [first, _] = self.beta.nodes;
        first
    }
}
