//! Radiance of a photographer's studio.

use glam::Vec3;

/// Width and height of the picture.
pub(super) const SIZE: [u32; 2] = [128, 64];

/// Radiance of every pixel of an equirectangular picture of [`SIZE`], linear Rec. 709.
pub(super) fn pixels() -> Vec<[f32; 3]> {
    // Full within a soft edge of 0.05 around a half width.
    let within = |distance: f32, half: f32| ((half + 0.05 - distance) / 0.1).clamp(0.0, 1.0);
    let radiance = |x: u32, y: u32| {
        #[allow(clippy::cast_precision_loss, reason = "a hundred")]
        let (u, v) = ((x as f32 + 0.5) / SIZE[0] as f32, (y as f32 + 0.5) / SIZE[1] as f32);
        let (around, down) = (std::f32::consts::TAU * (u - 0.5), std::f32::consts::PI * v);
        let direction = Vec3::new(down.sin() * around.sin(), down.cos(), down.sin() * around.cos());
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
        (walls + overhead * Vec3::new(0.42, 0.44, 0.46) + strip * Vec3::new(0.7, 0.62, 0.5)).into()
    };
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))).map(|(x, y)| radiance(x, y)).collect()
}
