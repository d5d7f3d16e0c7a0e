//! Radiance of a photographer's studio.

use glam::Vec3;

/// 1 within a half width, falling to 0 over a soft edge of 0.1 around it.
pub(super) fn within(distance: f32, half: f32) -> f32 {
    ((half + 0.05 - distance) / 0.1).clamp(0.0, 1.0)
}

/// Radiance from a unit direction, linear Rec. 709.
pub(super) fn radiance(direction: Vec3) -> Vec3 {
    let walls = Vec3::new(0.13, 0.14, 0.16) * (1.0 + 0.4 * direction.y);
    // On a plane 1 above: the overhead box. On one 1 to the left: the strip.
    let overhead = if direction.y > 0.1 {
        let on_plane = direction / direction.y;
        within(on_plane.x.abs(), 0.8) * within((on_plane.z - 0.3).abs(), 0.6)
    } else {
        0.0
    };
    let strip = if direction.x < -0.1 {
        let on_plane = direction / -direction.x;
        within((on_plane.z - 0.9).abs(), 0.25) * within((on_plane.y - 0.2).abs(), 0.7)
    } else {
        0.0
    };
    walls + overhead * Vec3::new(0.42, 0.44, 0.46) + strip * Vec3::new(0.7, 0.62, 0.5)
}
