//! Mapping of materials to surfaces; the twin of `mapping.wgsl`.

use glam::{UVec3, Vec2, Vec3};

/// Rule by which pixels of a patch lie on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mapping {
    /// Texture coordinates; the unit square of them shows so many copies of the patch in u and in v.
    Uv([f32; 2]),
    /// Box mapping: the patch in its own size, from the side of a box that each normal faces most.
    Box,
}

/// Shares of the three sides of a box that a normal faces.
fn sides_of(normal: Vec3) -> Vec3 {
    let n8 = normal.powf(2.0).powf(4.0);
    n8 / n8.element_sum()
}

/// Random number from 0 to 1 for every block of half a pixel of the material (hash of three integers after Jarzynski and
/// Olano 2020).
fn chance(position_mm: Vec3, pitch_mm: f32) -> f32 {
    let cell = (position_mm / (0.5 * pitch_mm)).floor().as_ivec3().to_array().map(i32::cast_unsigned);
    let [mut x, mut y, mut z] = cell.map(|k| k.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    x = x.wrapping_add(y.wrapping_mul(z));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    let mixed: UVec3 = UVec3::new(x, y, z) ^ (UVec3::new(x, y, z) >> 16_u32);
    x = mixed.x.wrapping_add(mixed.y.wrapping_mul(mixed.z));
    #[allow(clippy::cast_precision_loss, reason = "24 bits")]
    let part = (x >> 8) as f32 / 16_777_216.0;
    part
}

/// Coordinates in mm on one of the sides of a box, each in its own size and upright where it can be; where sides meet,
/// one or the other by chance.
#[must_use]
pub fn place_in_box(position_mm: Vec3, normal: Vec3, pitch_mm: f32) -> Vec2 {
    let (p, n) = (position_mm, normal);
    let side = |component: f32| if component >= 0.0 { 1.0 } else { -1.0 };
    let sides = sides_of(n);
    let dice = chance(p, pitch_mm);
    if dice < sides.x {
        Vec2::new(-p.z * side(n.x), -p.y)
    } else if dice < sides.x + sides.y {
        Vec2::new(p.x, p.z * side(n.y))
    } else {
        Vec2::new(p.x * side(n.z), -p.y)
    }
}
