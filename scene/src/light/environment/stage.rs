//! Radiance of a dark stage.

use glam::Vec3;

use super::studio::within;

/// Radiance from a unit direction, linear Rec. 709.
pub(super) fn radiance(direction: Vec3) -> Vec3 {
    let night = Vec3::new(0.030, 0.040, 0.060) * (1.0 + 0.5 * direction.y);
    // On a plane 1 above: a box behind what is seen from z and x. On one 1 to the left: a tall strip.
    let overhead = if direction.y > 0.1 {
        let on_plane = direction / direction.y;
        within((on_plane.x + 0.4).abs(), 0.9) * within((on_plane.z + 1.0).abs(), 0.7)
    } else {
        0.0
    };
    let strip = if direction.x < -0.1 {
        let on_plane = direction / -direction.x;
        within((on_plane.z - 1.1).abs(), 0.2) * within((on_plane.y - 0.5).abs(), 0.8)
    } else {
        0.0
    };
    night + overhead * Vec3::new(0.16, 0.20, 0.28) + strip * Vec3::new(0.30, 0.36, 0.48)
}
