//! The [α, β] × [θ_v, φ_v] parametrisation of light and view (Havran, Filip and Myszkowski 2010, section 4.1).
//!
//! With x along the view's azimuth, y across it and z the normal, a light is [cos β sin α, sin β, cos β cos α]: slices
//! of constant α run across the plane of view, and β = 0 lies in it. Their β = arcsin(sin θ cos Δφ) contradicts their
//! text; sin Δφ is meant. Nodes are uniform in α, sin β, θ_v and φ_v, and dω = d(sin β) dα.

use super::angle::{atan2, sqrt};
use super::coord::{GridCoord, LerpCoord};
use core::f32::consts::TAU;

/// Largest number of nodes of an axis.
pub(in crate::btf) const MAX_NODES: u8 = 64;

/// Nodes of directions: how many each axis has, and how far they reach. A table over a grid has the shape `[φ_v][θ_v][α][β]`.
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

/// Direction of view, prepared for many lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Azimuth φ_v.
    pub phi: LerpCoord,
    /// Angle θ_v from the normal.
    pub theta: LerpCoord,
    /// cos φ_v and sin φ_v.
    pub(crate) azimuth: [f32; 2],
}

impl Grid {
    /// Grid of Havran et al. 2010: 11 × 11 × 7 × 16 nodes over hemispheres.
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

    /// Number of nodes of lights, n_α · n_β.
    #[must_use]
    pub fn light_nodes(&self) -> usize {
        usize::from(self.n_alpha).wrapping_mul(usize::from(self.n_beta))
    }

    /// Number of nodes of views, n_θ · n_φ.
    #[must_use]
    pub fn view_nodes(&self) -> usize {
        usize::from(self.n_theta).wrapping_mul(usize::from(self.n_phi))
    }

    /// View in the direction of a unit vector: x along the rows of the material, y down its columns, z its normal.
    #[must_use]
    pub fn view(&self, view: [f32; 3]) -> View {
        let [_, _, z] = view;
        let Azimuth { x, y, length, sin_theta } = Azimuth::of(view);
        let (phi, theta) = self.view_coords(atan2(y, x), atan2(sin_theta, z));
        let per_length = 1.0 / length;
        View { phi, theta, azimuth: [x * per_length, y * per_length] }
    }

    /// Coordinates of a light, a unit vector too, for one view.
    #[must_use]
    pub fn coord_for(&self, light: [f32; 3], view: &View) -> GridCoord {
        let ([forward, sin_beta], [_, _, z]) = (Self::in_frame(light, view.azimuth), light);
        self.coord_at((view.phi, view.theta), atan2(forward, z.max(0.0)), sin_beta, z)
    }

    /// Coordinates of unit vectors towards light and eye: [`Self::coord_for`] of a [`Self::view`], faster than both.
    #[must_use]
    pub fn coord(&self, light: [f32; 3], view: [f32; 3]) -> GridCoord {
        let ([_, _, light_z], [_, _, view_z]) = (light, view);
        let Azimuth { x, y, length, sin_theta } = Azimuth::of(view);
        // Times the length, so that no angle waits for a division.
        let [forward, across] = Self::in_frame(light, [x, y]);
        let alpha = atan2(forward, length * light_z.max(0.0));
        self.coord_at(self.view_coords(atan2(y, x), atan2(sin_theta, view_z)), alpha, across / length, light_z)
    }

    /// Coordinates of φ_v and θ_v in rad.
    #[inline]
    fn view_coords(&self, phi: f32, theta: f32) -> (LerpCoord, LerpCoord) {
        let turns = phi * (1.0 / TAU);
        let turns = if turns < 0.0 { turns + 1.0 } else { turns };
        let per_rad = (f32::from(self.n_theta) - 1.0) / self.theta_max;
        (LerpCoord::on_ring(turns, self.n_phi), LerpCoord::on_line(theta * per_rad, self.n_theta))
    }

    /// Coordinates from those of a view, α in rad, sin β and cos θ_i.
    #[inline]
    pub(in crate::btf) fn coord_at(
        &self,
        (phi, theta): (LerpCoord, LerpCoord),
        alpha: f32,
        sin_beta: f32,
        cos_light: f32,
    ) -> GridCoord {
        let beta = LerpCoord::around(sin_beta, self.sin_beta_max, self.n_beta);
        GridCoord { phi, theta, alpha: self.alpha(alpha), beta, fade: self.fade(cos_light) }
    }

    /// Coordinate of α in rad.
    #[inline]
    pub(crate) fn alpha(&self, alpha: f32) -> LerpCoord {
        LerpCoord::around(alpha, self.alpha_max, self.n_alpha)
    }

    /// Factor of values: min(1, cos θ_i / cos θ_i of the lowest measured light), 0 below the horizon.
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

/// Part of a direction along the surface, and its length, which is not 0.
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

    fn position(coord: LerpCoord) -> f32 {
        let [first, _] = coord.nodes;
        f32::from(u8::try_from(first).unwrap()) + coord.weight
    }

    #[test]
    fn the_mirror_direction_lies_in_the_plane_of_view() {
        let grid = Grid::PAPER;
        for phi in [0.0, 33.0, 190.0, 359.0] {
            let view = grid.view(unit(45.0, phi));
            let mirror = grid.coord_for(unit(45.0, phi + 180.0), &view);
            assert!((position(mirror.beta) - 5.0).abs() < 1e-4, "β = 0: {mirror:?}");
            assert!((position(mirror.alpha) - 2.5).abs() < 1e-4, "α = −45°: {mirror:?}");
            let across = grid.coord_for(unit(30.0, phi + 90.0), &view);
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
    fn coordinates_lead_back_to_lights() {
        let grid = Grid::PAPER;
        let view = grid.view(unit(70.0, 100.0));
        for light in [unit(20.0, 40.0), unit(80.0, 300.0), unit(0.0, 0.0), unit(50.0, 190.0)] {
            let coord = grid.coord_for(light, &view);
            let alpha = (position(coord.alpha) / 5.0 - 1.0) * core::f32::consts::FRAC_PI_2;
            let back =
                Grid::light([libm::sinf(alpha), libm::cosf(alpha)], position(coord.beta) / 5.0 - 1.0, view.azimuth);
            let error = light.iter().zip(back).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(error < 1e-4, "{light:?} {back:?}");
        }
    }

    #[test]
    fn what_is_not_a_direction_is_harmless() {
        let grid = Grid::PAPER;
        for odd in [[f32::NAN; 3], [f32::INFINITY; 3], [0.0; 3], [-1.0, 0.0, -5.0]] {
            let view = grid.view(odd);
            let coord = grid.coord_for(odd, &view);
            for (axis, count) in [(coord.phi, 16), (coord.theta, 7), (coord.alpha, 11), (coord.beta, 11)] {
                let [a, b] = axis.nodes;
                assert!(a < count && b < count, "{odd:?}: {axis:?}");
            }
        }
        assert_eq!(
            grid.coord_for([0.0, 0.0, -1.0], &grid.view([0.0, 0.0, 1.0])).fade.to_bits(),
            0,
            "below the horizon"
        );
    }
}
