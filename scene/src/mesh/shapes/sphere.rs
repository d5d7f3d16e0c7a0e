//! Spheres, smooth and with bumps.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::lattice::grid;
use crate::mesh::triangles::Mesh;

/// Sphere of `radius_mm`, with `rings` rings of twice as many quads; u goes around, v from pole to pole.
///
/// # Panics
/// If `rings` is less than 2 or the radius not positive.
#[must_use]
pub fn sphere(radius_mm: f32, rings: u16) -> Mesh {
    assert!(rings >= 2 && radius_mm > 0.0, "{rings} rings of radius {radius_mm}");
    grid([2 * rings, rings], |uv| (direction(uv) * radius_mm, direction(uv)))
}

/// Sphere of `radius_mm` on average with smooth bumps and hollows, about `bumps` of each around it, less than 2.1 /
/// (1 + 1.25 · `bumps`) of the radius high; `rings` rings of twice as many quads. u goes around, v from pole to pole.
///
/// # Panics
/// If `rings` is less than 2, `bumps` is 0 or the radius not positive.
#[must_use]
pub fn relief(radius_mm: f32, bumps: u16, rings: u16) -> Mesh {
    assert!(rings >= 2 && bumps >= 1 && radius_mm > 0.0, "{rings} rings of radius {radius_mm}, {bumps} bumps");
    let frequency = 1.25 * f32::from(bumps);
    let size = 0.35 / (1.0 + frequency);
    grid([2 * rings, rings], |uv| {
        let direction = direction(uv);
        // r = R (1 + h), h = Σ a sin(k · d + phase), and its gradient in d.
        let (mut height, mut gradient) = (0.0, Vec3::ZERO);
        for (wave, phase) in WAVES {
            let (sin, cos) = (frequency * wave.dot(direction) + phase).sin_cos();
            height += size * sin;
            gradient += size * frequency * cos * wave;
        }
        // n ~ (1 + h) d − the part of the gradient along the sphere.
        let along = gradient - direction * gradient.dot(direction);
        (direction * (1.0 + height) * radius_mm, (direction * (1.0 + height) - along).normalize())
    })
}

/// Directions and phases of the waves of [`relief`]: the six axes of an icosahedron, so that no side has more bumps.
const WAVES: [(Vec3, f32); 6] = [
    (Vec3::new(0.0, SHORT, LONG), 0.4),
    (Vec3::new(0.0, SHORT, -LONG), 2.9),
    (Vec3::new(SHORT, LONG, 0.0), 1.9),
    (Vec3::new(SHORT, -LONG, 0.0), 5.3),
    (Vec3::new(LONG, 0.0, SHORT), 4.1),
    (Vec3::new(-LONG, 0.0, SHORT), 0.9),
];

/// Sides of the corners of an icosahedron: 1 and the golden section, over the length of both.
const SHORT: f32 = 0.525_731_1;
const LONG: f32 = 0.850_650_8;

/// Direction from the middle of a sphere to the place of texture coordinates.
fn direction(uv: Vec2) -> Vec3 {
    let (theta, phi) = (PI * (1.0 - uv.y), TAU * uv.x);
    Vec3::new(theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos())
}
