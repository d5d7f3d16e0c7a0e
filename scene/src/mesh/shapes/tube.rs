//! Tubes that close: a torus and a knot.

use std::f32::consts::TAU;

use glam::Vec3;

use super::lattice::grid;
use crate::mesh::triangles::Mesh;

/// Torus around the y axis: a tube of radius `tube_mm` whose middle runs `radius_mm` from the axis, with `rings`
/// quads around the tube and three times as many along it.
///
/// # Panics
/// If `rings` is less than 3 or a radius not positive.
#[must_use]
pub fn torus(radius_mm: f32, tube_mm: f32, rings: u16) -> Mesh {
    assert!(rings >= 3 && radius_mm > 0.0 && tube_mm > 0.0, "{rings} rings of radii {radius_mm}, {tube_mm}");
    grid([3 * rings, rings], |uv| {
        let (along, around) = (TAU * uv.x, TAU * uv.y);
        let outwards = Vec3::new(along.sin(), 0.0, along.cos());
        let normal = outwards * around.cos() + Vec3::Y * around.sin();
        (outwards * radius_mm + normal * tube_mm, normal)
    })
}

/// Tube of radius `tube_mm` around a trefoil, the (2, 3) knot on a torus around the y axis whose middle runs
/// `radius_mm` from the axis; with `rings` quads around the tube and eight times as many along it. Spans 1.45 ·
/// `radius_mm` + `tube_mm` to either side; u goes along the knot, within 9 % in its length, v around the tube.
///
/// # Panics
/// If `rings` is less than 3, a radius not positive, or the tube so thick that it touches itself: `tube_mm` of 0.44 ·
/// `radius_mm` or more.
#[must_use]
pub fn knot(radius_mm: f32, tube_mm: f32, rings: u16) -> Mesh {
    assert!(rings >= 3 && radius_mm > 0.0 && tube_mm > 0.0, "{rings} rings of radii {radius_mm}, {tube_mm}");
    assert!(tube_mm < 0.44 * radius_mm, "a tube of {tube_mm} mm touches itself in a knot of {radius_mm} mm");
    let depth = 0.45;
    grid([8 * rings, rings], |uv| {
        // Slower where the knot runs far from the axis, so that u follows its length.
        let t = TAU * uv.x - 0.1 * (3.0 * TAU * uv.x).sin();
        let (sin_2, cos_2) = (2.0 * t).sin_cos();
        let (sin_3, cos_3) = (3.0 * t).sin_cos();
        let (outwards, along) = (Vec3::new(sin_2, 0.0, cos_2), Vec3::new(cos_2, 0.0, -sin_2));
        // c = (1 + d cos 3t) outwards + d sin 3t y, and dc/dt.
        let on_torus = outwards * cos_3 + Vec3::Y * sin_3;
        let middle = outwards + on_torus * depth;
        let speed = along * (2.0 + 2.0 * depth * cos_3) + (Vec3::Y * cos_3 - outwards * sin_3) * (3.0 * depth);
        // The normal of the torus turns around the knot 2.6 times; three turns back leave the least twist that closes.
        let around = TAU * uv.y - 3.0 * t;
        let normal = on_torus * around.cos() + on_torus.cross(speed.normalize()) * around.sin();
        (middle * radius_mm + normal * tube_mm, normal)
    })
}
