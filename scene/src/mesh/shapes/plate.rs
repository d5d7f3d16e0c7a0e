//! A round plate with a round edge.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::lattice::{EDGE, lattice, spans};
use crate::mesh::triangles::Mesh;

/// Round plate of `thickness_mm` whose upper side is the plane y = 0 around the origin; its edge is round and `radius_mm` from
/// the y axis. `rings` rings of quads above and half as many below, each of four times as many quads as `rings`. u goes around,
/// v from the middle below over the edge to the middle above.
///
/// # Panics
/// If `rings` is less than 2, or the thickness not positive or not less than the radius.
#[must_use]
pub fn plate(radius_mm: f32, thickness_mm: f32, rings: u16) -> Mesh {
    assert!(rings >= 2 && thickness_mm > 0.0, "{rings} rings of thickness {thickness_mm}");
    assert!(thickness_mm < radius_mm, "a plate {thickness_mm} mm thick and {radius_mm} mm in radius");
    let half_mm = 0.5 * thickness_mm;
    let flat = radius_mm - half_mm;
    let rim = PI * half_mm;
    let length = flat + rim + flat;
    lattice(&spans(&[(1.0, 4 * rings)]), &spans(&[(flat, rings / 2), (rim, EDGE), (flat, rings)]), |uv| {
        // Profile as (outwards, up), at a distance along it.
        let at = uv.y * length;
        let (place, normal) = if at < flat {
            (Vec2::new(at, -thickness_mm), Vec2::NEG_Y)
        } else if at < flat + rim {
            let normal = Vec2::from_angle((at - flat) / half_mm - 0.5 * PI);
            (Vec2::new(flat, -half_mm) + normal * half_mm, normal)
        } else {
            (Vec2::new((length - at).max(0.0), 0.0), Vec2::Y)
        };
        let outwards = Vec3::new((TAU * uv.x).sin(), 0.0, (TAU * uv.x).cos());
        let turned = |at: Vec2| outwards * at.x + Vec3::Y * at.y;
        (turned(place), turned(normal))
    })
}
