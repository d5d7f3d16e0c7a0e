//! A bowl with a thin wall.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Vec2, Vec3};

use super::lattice::{EDGE, lattice, spans};
use crate::mesh::triangles::Mesh;

/// Bowl around the y axis, open upwards: a wall of `thickness_mm` from a half sphere of `radius_mm` around the origin
/// inwards, with a round rim; `rings` rings of quads outside and as many inside, each of four times as many quads. The
/// wall is closed: it has an inside. u goes around, v from the lowest point outside over the rim to that inside.
///
/// # Panics
/// If `rings` is less than 2, or the thickness not positive or not less than the radius.
#[must_use]
pub fn bowl(radius_mm: f32, thickness_mm: f32, rings: u16) -> Mesh {
    assert!(rings >= 2 && thickness_mm > 0.0, "{rings} rings of thickness {thickness_mm}");
    assert!(thickness_mm < radius_mm, "a wall of {thickness_mm} mm in a bowl of {radius_mm} mm");
    let (half_mm, inner_mm) = (0.5 * thickness_mm, radius_mm - thickness_mm);
    let [outside, rim, inside] = [FRAC_PI_2 * radius_mm, PI * half_mm, FRAC_PI_2 * inner_mm];
    let length = outside + rim + inside;
    lattice(&spans(&[(1.0, 4 * rings)]), &spans(&[(outside, rings), (rim, EDGE), (inside, rings)]), |uv| {
        // An arc around a middle, both as (outwards, up), at a distance along the profile.
        let at = uv.y * length;
        let (middle, arc_mm, angle) = if at < outside {
            (Vec2::ZERO, radius_mm, at / radius_mm - FRAC_PI_2)
        } else if at < outside + rim {
            (Vec2::X * (radius_mm - half_mm), half_mm, (at - outside) / half_mm)
        } else {
            (Vec2::ZERO, -inner_mm, FRAC_PI_2 + (length - at) / inner_mm)
        };
        let outwards = Vec3::new((TAU * uv.x).sin(), 0.0, (TAU * uv.x).cos());
        let turned = |at: Vec2| outwards * at.x + Vec3::Y * at.y;
        let normal = Vec2::from_angle(angle);
        (turned(middle + normal * arc_mm), turned(normal))
    })
}
