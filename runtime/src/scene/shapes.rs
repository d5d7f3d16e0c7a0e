//! Meshes that need no file.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::mesh::Mesh;

/// A sphere of `radius_mm`, with `rings` rings of twice as many quads; u goes around, v from pole to pole.
///
/// # Panics
/// If `rings` is less than 2 or the radius not positive.
#[must_use]
pub fn sphere(radius_mm: f32, rings: u16) -> Mesh {
    assert!(rings >= 2 && radius_mm > 0.0, "{rings} rings of radius {radius_mm}");
    let direction = |uv: Vec2| {
        let (theta, phi) = (PI * (1.0 - uv.y), TAU * uv.x);
        Vec3::new(theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos())
    };
    grid([2 * rings, rings], |uv| (direction(uv) * radius_mm, direction(uv)))
}

/// A torus around the y axis: a tube of radius `tube_mm` whose middle runs `radius_mm` from the axis, with `rings`
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

/// A rectangle of quads in u and v, placed by `place`.
fn grid([columns, rows]: [u16; 2], place: impl Fn(Vec2) -> (Vec3, Vec3)) -> Mesh {
    let steps = |n: u16| (0..=n).map(move |k| f32::from(k) / f32::from(n));
    let uvs: Vec<Vec2> = steps(rows).flat_map(|v| steps(columns).map(move |u| Vec2::new(u, v))).collect();
    let (positions, normals) = uvs.iter().map(|uv| place(*uv)).unzip();
    let stride = u32::from(columns) + 1;
    let quads = (0..u32::from(rows)).flat_map(|y| (0..u32::from(columns)).map(move |x| y * stride + x));
    let triangles = quads.flat_map(|a| [[a, a + 1, a + stride], [a + 1, a + stride + 1, a + stride]]).collect();
    Mesh { positions, normals, uvs: Some(uvs), triangles }
}
