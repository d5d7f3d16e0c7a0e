//! The [α, β] × [θ_v, φ_v] parametrisation of light and view (Havran, Filip and Myszkowski 2010, section 4.1).
//!
//! With x along the view's azimuth, y across it and z the normal, a light is [cos β sin α, sin β, cos β cos α]: slices
//! of constant α run across the plane of view, and β = 0 lies in it. Their β = arcsin(sin θ cos Δφ) contradicts their
//! text; sin Δφ is meant. Nodes are uniform in α, sin β, θ_v and φ_v, and dω = d(sin β) dα.

use super::angle::{atan2, sqrt};
use core::f32::consts::TAU;

/// Most nodes of an axis.
pub(in crate::btf) const MAX_NODES: u8 = 64;

/// Numbers of nodes and how far they reach. A table over it has the shape `[φ_v][θ_v][α][β]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Nodes of α, 2 to 64, from −α_max to α_max.
    pub n_alpha: u8,
    /// Nodes of sin β, 2 to 64, from −s_max to s_max.
    pub n_beta: u8,
    /// Nodes of θ_v, 2 to 64, from 0 to θ_max.
    pub n_theta: u8,
    /// Nodes of φ_v, 1 to 64, from 0 in steps of 2 π / n; node n is node 0.
    pub n_phi: u8,
    /// α_max in rad, above 0, to π/2.
    pub alpha_max: f32,
    /// Largest sin β, above 0, to 1.
    pub sin_beta_max: f32,
    /// Largest θ_v in rad, above 0, to π/2.
    pub theta_max: f32,
    /// cos θ_i of the lowest light that was measured, 0 to below 1. Lower ones fade to black at the horizon.
    pub cos_light_min: f32,
}

/// Place between two nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place {
    /// The two nodes.
    pub nodes: [u32; 2],
    /// Weight of the second, 0 to 1.
    pub weight: f32,
}

impl Place {
    /// Weights of both nodes.
    #[must_use]
    pub fn weights(self) -> [f32; 2] {
        [1.0 - self.weight, self.weight]
    }

    /// `t` in nodes from the first of `count`, at least two; clamped to them.
    #[inline]
    pub(crate) fn on_line(t: f32, count: u8) -> Self {
        let last = f32::from(count) - 1.0;
        let (first, weight) = split(t, last);
        Self { nodes: [first, first.wrapping_add(1)], weight }
    }

    /// `value` among `count` nodes from −`max` to `max`.
    #[inline]
    fn around(value: f32, max: f32, count: u8) -> Self {
        let middle = 0.5 * (f32::from(count) - 1.0);
        Self::on_line(value * (middle / max) + middle, count)
    }

    /// `t` turns, 0 to 1, on a ring of `count` nodes.
    #[inline]
    fn on_ring(t: f32, count: u8) -> Self {
        let count = u32::from(count);
        #[allow(clippy::cast_precision_loss, reason = "at most 64")]
        let nodes = count as f32;
        let (first, weight) = split(t * nodes, nodes);
        let next = first.wrapping_add(1);
        Self { nodes: [first, if next == count { 0 } else { next }], weight }
    }
}

/// Whole and rest of a number that is clamped to 0 to `end`; at `end`, the rest is 1. NaN is 0.
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

/// Where a pair of directions falls on a grid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cell {
    /// Of the view's azimuth.
    pub phi: Place,
    /// Of its angle from the normal.
    pub theta: Place,
    /// Of the light's slice.
    pub alpha: Place,
    /// Of its place on the slice.
    pub beta: Place,
    /// What values are multiplied by: 1 where lights were measured, less below, 0 below the horizon.
    pub fade: f32,
}

impl Cell {
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

/// A view direction, prepared for many lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Of its azimuth.
    pub phi: Place,
    /// Of its angle from the normal.
    pub theta: Place,
    /// cos φ_v and sin φ_v.
    pub(crate) azimuth: [f32; 2],
}

impl Grid {
    /// The grid of the paper: 11 × 11 × 7 × 16 nodes over hemispheres.
    pub const PAPER: Self = Self {
        n_alpha: 11,
        n_beta: 11,
        n_theta: 7,
        n_phi: 16,
        alpha_max: core::f32::consts::FRAC_PI_2,
        sin_beta_max: 1.0,
        theta_max: core::f32::consts::FRAC_PI_2,
        cos_light_min: 0.0,
    };

    /// Nodes of lights.
    #[must_use]
    pub fn light_nodes(&self) -> usize {
        usize::from(self.n_alpha).wrapping_mul(usize::from(self.n_beta))
    }

    /// Nodes of views.
    #[must_use]
    pub fn view_nodes(&self) -> usize {
        usize::from(self.n_theta).wrapping_mul(usize::from(self.n_phi))
    }

    /// A view, as a unit vector: x along the rows of the material, y down its columns, z its normal.
    #[must_use]
    pub fn view(&self, view: [f32; 3]) -> View {
        let [_, _, z] = view;
        let Azimuth { x, y, length, sin_theta } = Azimuth::of(view);
        let (phi, theta) = self.view_places(atan2(y, x), atan2(sin_theta, z));
        let per_length = 1.0 / length;
        View { phi, theta, azimuth: [x * per_length, y * per_length] }
    }

    /// Where a light falls, a unit vector too, for one view.
    #[must_use]
    pub fn cell(&self, light: [f32; 3], view: &View) -> Cell {
        let ([forward, sin_beta], [_, _, z]) = (Self::in_frame(light, view.azimuth), light);
        self.cell_at((view.phi, view.theta), atan2(forward, z.max(0.0)), sin_beta, z)
    }

    /// [`Self::cell`] of a [`Self::view`], faster than both.
    #[must_use]
    pub fn pair(&self, light: [f32; 3], view: [f32; 3]) -> Cell {
        let ([_, _, light_z], [_, _, view_z]) = (light, view);
        let Azimuth { x, y, length, sin_theta } = Azimuth::of(view);
        // Times the length, so that no angle waits for a division.
        let [forward, across] = Self::in_frame(light, [x, y]);
        let alpha = atan2(forward, length * light_z.max(0.0));
        self.cell_at(self.view_places(atan2(y, x), atan2(sin_theta, view_z)), alpha, across / length, light_z)
    }

    /// Places of φ_v and θ_v in rad.
    #[inline]
    fn view_places(&self, phi: f32, theta: f32) -> (Place, Place) {
        let turns = phi * (1.0 / TAU);
        let turns = if turns < 0.0 { turns + 1.0 } else { turns };
        let per_rad = (f32::from(self.n_theta) - 1.0) / self.theta_max;
        (Place::on_ring(turns, self.n_phi), Place::on_line(theta * per_rad, self.n_theta))
    }

    /// The cell of two places of view, α in rad, sin β and cos θ_i.
    #[inline]
    pub(in crate::btf) fn cell_at(
        &self,
        (phi, theta): (Place, Place),
        alpha: f32,
        sin_beta: f32,
        cos_light: f32,
    ) -> Cell {
        let beta = Place::around(sin_beta, self.sin_beta_max, self.n_beta);
        Cell { phi, theta, alpha: self.alpha(alpha), beta, fade: self.fade(cos_light) }
    }

    /// Place of α in rad.
    #[inline]
    pub(crate) fn alpha(&self, alpha: f32) -> Place {
        Place::around(alpha, self.alpha_max, self.n_alpha)
    }

    /// min(1, cos θ_i / cos θ_i of the lowest measured light), 0 below the horizon.
    #[inline]
    pub(crate) fn fade(&self, cos_theta: f32) -> f32 {
        // NaN is below the horizon.
        let above = cos_theta.max(0.0);
        if above >= self.cos_light_min { f32::from(u8::from(above > 0.0)) } else { above / self.cos_light_min }
    }

    /// A direction in the frame of a view: along its azimuth, and across its plane, which is sin β.
    #[inline]
    pub(crate) fn in_frame([x, y, _]: [f32; 3], [cos_phi, sin_phi]: [f32; 2]) -> [f32; 2] {
        [x * cos_phi + y * sin_phi, y * cos_phi - x * sin_phi]
    }

    /// The light at sine and cosine of α and at sin β, for the azimuth of a view.
    #[inline]
    pub(crate) fn light([sin_alpha, cos_alpha]: [f32; 2], sin_beta: f32, [cos_phi, sin_phi]: [f32; 2]) -> [f32; 3] {
        let cos_beta = sqrt(1.0 - sin_beta * sin_beta);
        let forward = cos_beta * sin_alpha;
        [forward * cos_phi - sin_beta * sin_phi, forward * sin_phi + sin_beta * cos_phi, cos_beta * cos_alpha]
    }
}

/// The part of a direction along the surface, and its length, which is not 0.
struct Azimuth {
    x: f32,
    y: f32,
    length: f32,
    sin_theta: f32,
}

impl Azimuth {
    #[inline]
    fn of([x, y, _]: [f32; 3]) -> Self {
        let sin_theta = sqrt(x * x + y * y);
        // Straight above, and where it is no number, the azimuth is 0.
        if sin_theta > 1e-6 && sin_theta.is_finite() {
            Self { x, y, length: sin_theta, sin_theta }
        } else {
            Self { x: 1.0, y: 0.0, length: 1.0, sin_theta }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic fails the test")]
mod tests {
    use super::*;

    fn unit(theta_deg: f32, phi_deg: f32) -> [f32; 3] {
        let (theta, phi) = (theta_deg.to_radians(), phi_deg.to_radians());
        [libm::sinf(theta) * libm::cosf(phi), libm::sinf(theta) * libm::sinf(phi), libm::cosf(theta)]
    }

    fn position(place: Place) -> f32 {
        let [first, _] = place.nodes;
        f32::from(u8::try_from(first).unwrap()) + place.weight
    }

    #[test]
    fn the_mirror_direction_lies_in_the_plane_of_view() {
        let grid = Grid::PAPER;
        for phi in [0.0, 33.0, 190.0, 359.0] {
            let view = grid.view(unit(45.0, phi));
            let mirror = grid.cell(unit(45.0, phi + 180.0), &view);
            assert!((position(mirror.beta) - 5.0).abs() < 1e-4, "β = 0: {mirror:?}");
            assert!((position(mirror.alpha) - 2.5).abs() < 1e-4, "α = −45°: {mirror:?}");
            let across = grid.cell(unit(30.0, phi + 90.0), &view);
            assert!((position(across.beta) - 7.5).abs() < 1e-4, "sin β = ½: {across:?}");
            assert!((position(across.alpha) - 5.0).abs() < 1e-3, "α = 0: {across:?}");
            assert!((position(view.theta) - 3.0).abs() < 1e-4, "45° of 15° steps: {view:?}");
            assert!((position(view.phi) - phi / 22.5).abs() < 1e-3, "{view:?}");
        }
    }

    #[test]
    fn azimuths_close_the_ring() {
        let grid = Grid::PAPER;
        let last = grid.view(unit(60.0, 359.0)).phi;
        assert_eq!(last.nodes, [15, 0]);
        let first = grid.view([0.5, -0.0, 0.5]).phi;
        assert_eq!(first.nodes, [0, 1], "−0 is 0");
    }

    #[test]
    fn places_lead_back_to_lights() {
        let grid = Grid::PAPER;
        let view = grid.view(unit(70.0, 100.0));
        for light in [unit(20.0, 40.0), unit(80.0, 300.0), unit(0.0, 0.0), unit(50.0, 190.0)] {
            let cell = grid.cell(light, &view);
            let alpha = (position(cell.alpha) / 5.0 - 1.0) * core::f32::consts::FRAC_PI_2;
            let back =
                Grid::light([libm::sinf(alpha), libm::cosf(alpha)], position(cell.beta) / 5.0 - 1.0, view.azimuth);
            let error = light.iter().zip(back).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(error < 1e-4, "{light:?} {back:?}");
        }
    }

    #[test]
    fn what_is_not_a_direction_is_harmless() {
        let grid = Grid::PAPER;
        for odd in [[f32::NAN; 3], [f32::INFINITY; 3], [0.0; 3], [-1.0, 0.0, -5.0]] {
            let view = grid.view(odd);
            let cell = grid.cell(odd, &view);
            for (place, count) in [(cell.phi, 16), (cell.theta, 7), (cell.alpha, 11), (cell.beta, 11)] {
                let [a, b] = place.nodes;
                assert!(a < count && b < count, "{odd:?}: {place:?}");
            }
        }
        assert_eq!(grid.cell([0.0, 0.0, -1.0], &grid.view([0.0, 0.0, 1.0])).fade.to_bits(), 0, "below the horizon");
    }
}
