//! Eye that goes around the mesh, and light that can be dragged.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec2, Vec3};
use subsurf_scene::Camera;

/// Eye that looks at a point from all around.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orbit {
    target_mm: Vec3,
    /// Around the up axis, from z towards x.
    around: f32,
    /// Above the horizon, less than a right angle.
    up: f32,
    distance_mm: f32,
    /// Least and largest distance.
    range_mm: [f32; 2],
    angle: f32,
}

/// The eye comes this close to the poles, where left and right would swap.
const HIGHEST: f32 = FRAC_PI_2 - 0.05;
/// Factor of the distance for a step of the wheel.
const STEP: f32 = 0.9;

impl Orbit {
    /// From where a view is seen; the eye may come three times nearer, which is still outside of what fills the view, and
    /// go four times further away.
    pub(super) fn of(view: &Camera) -> Self {
        let from = view.eye_mm - view.target_mm;
        let distance_mm = from.length().max(1e-3);
        Self {
            target_mm: view.target_mm,
            around: from.x.atan2(from.z),
            up: (from.y / distance_mm).asin().clamp(-HIGHEST, HIGHEST),
            distance_mm,
            range_mm: [0.3 * distance_mm, 4.0 * distance_mm],
            angle: view.fov_y_rad,
        }
    }

    /// Camera at its place.
    pub(super) fn view(&self, exposure: f32) -> Camera {
        let towards = Vec3::new(self.up.cos() * self.around.sin(), self.up.sin(), self.up.cos() * self.around.cos());
        Camera {
            eye_mm: self.target_mm + self.distance_mm * towards,
            target_mm: self.target_mm,
            fov_y_rad: self.angle,
            exposure,
        }
    }

    /// Turns what is seen with the pointer; `by` is in heights of the window, y down.
    pub(super) fn turn(&mut self, by: Vec2) {
        self.around -= by.x * PI;
        self.up = (self.up + by.y * PI).clamp(-HIGHEST, HIGHEST);
    }

    /// Comes nearer by steps of the wheel.
    pub(super) fn zoom(&mut self, steps: f32) {
        let [nearest, furthest] = self.range_mm;
        self.distance_mm = (self.distance_mm * STEP.powf(steps)).clamp(nearest, furthest);
    }
}

/// A light's direction after the pointer dragged it; `by` is in heights of the window, y down.
pub(super) fn dragged(towards: Vec3, by: Vec2, view: &Camera) -> Vec3 {
    let forward = (view.target_mm - view.eye_mm).normalize_or(Vec3::NEG_Z);
    let right = forward.cross(Vec3::Y).normalize_or(Vec3::X);
    let turn = Quat::from_axis_angle(right.cross(forward), by.x * PI) * Quat::from_axis_angle(right, by.y * PI);
    (turn * towards).normalize_or(Vec3::Y)
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIEW: Camera =
        Camera { eye_mm: Vec3::new(3.0, 4.0, 12.0), target_mm: Vec3::ZERO, fov_y_rad: 0.5, exposure: 1.0 };

    #[test]
    fn an_orbit_begins_where_the_view_is() {
        assert!(Orbit::of(&VIEW).view(1.0).eye_mm.distance(VIEW.eye_mm) < 1e-4, "the same eye");
    }

    #[test]
    fn turning_keeps_the_distance_and_stays_off_the_poles() {
        let mut orbit = Orbit::of(&VIEW);
        for by in [Vec2::new(0.3, 5.0), Vec2::new(-2.0, -9.0), Vec2::new(0.1, 0.2)] {
            orbit.turn(by);
            let eye = orbit.view(1.0).eye_mm;
            assert!((eye.length() - 13.0).abs() < 1e-3, "{eye}");
            assert!(eye.x.hypot(eye.z) > 0.5, "{eye}");
        }
    }

    #[test]
    fn zooming_ends_somewhere() {
        let mut orbit = Orbit::of(&VIEW);
        orbit.zoom(1000.0);
        assert!((orbit.view(1.0).eye_mm.length() - 3.9).abs() < 1e-3, "nearest");
        orbit.zoom(-1000.0);
        assert!((orbit.view(1.0).eye_mm.length() - 52.0).abs() < 1e-3, "furthest");
    }

    #[test]
    fn a_light_at_the_eye_follows_the_pointer() {
        let view = Camera { eye_mm: Vec3::Z, ..VIEW };
        let right = dragged(Vec3::Z, Vec2::new(0.1, 0.0), &view);
        assert!(right.x > 0.1 && right.y.abs() < 1e-5, "{right}");
        let down = dragged(Vec3::Z, Vec2::new(0.0, 0.1), &view);
        assert!(down.y < -0.1 && down.x.abs() < 1e-5, "{down}");
    }
}
