//! Shapes are closed, smooth, and as large as they say.

use std::collections::HashMap;
use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::Vec3;

use super::{bowl, drapery, knot, plate, relief, sphere, torus};
use crate::mesh::triangles::Mesh;

fn all() -> [(&'static str, Mesh); 11] {
    [
        ("sphere", sphere(10.0, 12)),
        ("torus", torus(10.0, 4.0, 10)),
        ("knot", knot(10.0, 3.0, 12)),
        ("bowl", bowl(10.0, 1.0, 10)),
        ("thick bowl", bowl(10.0, 9.0, 10)),
        ("drapery", drapery(10.0, 0.5, 6, 24)),
        ("thick drapery", drapery(10.0, 0.66, 7, 24)),
        ("one thin fold", drapery(10.0, 0.1, 1, 12)),
        ("relief", relief(10.0, 5, 30)),
        ("one bump", relief(10.0, 1, 12)),
        ("plate", plate(10.0, 2.0, 10)),
    ]
}

/// Vertices nearer than this are at the same place, but for rounding.
const SAME_MM: f32 = 2e-5;

/// For each vertex the first at the same place.
fn merged(mesh: &Mesh) -> Vec<u32> {
    let same = |a: Vec3| (0..).zip(&mesh.positions).find(|(_, b)| a.distance(**b) < SAME_MM);
    mesh.positions.iter().map(|a| same(*a).expect("a vertex is where it is").0).collect()
}

fn corners(mesh: &Mesh, triangle: [u32; 3]) -> [Vec3; 3] {
    triangle.map(|k| mesh.positions[k as usize])
}

/// Enclosed by triangles that are wound counter-clockwise as seen from outside, in mm³.
fn volume(mesh: &Mesh) -> f32 {
    let under = |[a, b, c]: [Vec3; 3]| a.dot(b.cross(c)) / 6.0;
    mesh.triangles.iter().map(|triangle| under(corners(mesh, *triangle))).sum()
}

#[test]
fn every_edge_has_two_triangles_of_opposite_ways() {
    for (name, mesh) in all() {
        let merged = merged(&mesh);
        let mut ways: HashMap<[u32; 2], usize> = HashMap::new();
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|k| merged[k as usize]);
            // At a pole, one side of a quad is a point.
            if a != b && b != c && c != a {
                for way in [[a, b], [b, c], [c, a]] {
                    *ways.entry(way).or_default() += 1;
                }
            }
        }
        for ([a, b], count) in &ways {
            assert_eq!(*count, 1, "{name}: from {a} to {b}");
            assert!(ways.contains_key(&[*b, *a]), "{name}: nothing beyond {a} to {b}");
        }
    }
}

#[test]
fn normals_are_of_unit_length_and_on_the_side_of_the_winding() {
    for (name, mesh) in all() {
        assert!(mesh.positions.iter().all(|position| position.is_finite()), "{name}");
        for normal in &mesh.normals {
            assert!((normal.length() - 1.0).abs() < 1e-5, "{name}: {normal}");
        }
        for triangle in &mesh.triangles {
            let [a, b, c] = corners(&mesh, *triangle);
            // At a pole, one side of a quad is a point.
            if [a.distance(b), b.distance(c), c.distance(a)].iter().any(|side| *side < SAME_MM) {
                continue;
            }
            let wound = (b - a).cross(c - a).normalize();
            for k in triangle {
                let cos = wound.dot(mesh.normals[*k as usize]);
                assert!(cos > 0.5, "{name}: {triangle:?} is wound at a cosine of {cos} to a normal");
            }
        }
        assert!(volume(&mesh) > 0.0, "{name} is inside out");
    }
}

#[test]
fn normals_are_upright_to_the_surface() {
    // The finer the mesh, the nearer its triangles are to the normals.
    let fine = [
        ("sphere", sphere(10.0, 200)),
        ("torus", torus(10.0, 4.0, 150)),
        ("knot", knot(10.0, 3.0, 100)),
        ("drapery", drapery(10.0, 0.5, 6, 150)),
        ("thick drapery", drapery(10.0, 0.66, 7, 150)),
        ("relief", relief(10.0, 5, 300)),
    ];
    for (name, mesh) in fine {
        let off = |triangle: &[u32; 3]| {
            let [a, b, c] = corners(&mesh, *triangle);
            let wound = (b - a).cross(c - a);
            let normal = triangle.iter().map(|k| mesh.normals[*k as usize]).sum::<Vec3>();
            (wound.length() - wound.dot(normal.normalize())).max(0.0)
        };
        let (off, area) = mesh.triangles.iter().fold((0.0, 0.0), |(sum, area), triangle| {
            let [a, b, c] = corners(&mesh, *triangle);
            (sum + off(triangle), area + (b - a).cross(c - a).length())
        });
        assert!(off < 1e-3 * area, "{name}: {}", off / area);
    }
}

#[test]
fn volumes_are_those_of_the_formulas() {
    let near = |mesh: Mesh, mm3: f32| {
        let ratio = volume(&mesh) / mm3;
        assert!((ratio - 1.0).abs() < 0.01, "{ratio} of {mm3} mm³");
    };
    near(sphere(10.0, 100), 4.0 / 3.0 * PI * 1000.0);
    near(torus(10.0, 4.0, 80), TAU * 10.0 * PI * 16.0);
    // A tube has the length of its middle times its section; the knot's is 15.34 R.
    near(knot(10.0, 3.0, 80), 153.37 * PI * 9.0);
    // Half a hollow sphere, and half a torus for the rim.
    near(bowl(10.0, 2.0, 80), 2.0 / 3.0 * PI * (1000.0 - 512.0) + TAU * 9.0 * FRAC_PI_2);
}

#[test]
fn texture_runs_along_the_knot_and_does_not_jump_at_the_join() {
    let rings = 24;
    let mesh = knot(10.0, 1.0, rings);
    let columns = usize::from(8 * rings);
    let steps: Vec<f32> = mesh.positions[..=columns].windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let mean = steps.iter().sum::<f32>() / columns as f32;
    for step in steps {
        assert!((step / mean - 1.0).abs() < 0.25, "a step of {step} mm where the mean is {mean} mm");
    }
    for row in mesh.normals.chunks_exact(columns + 1) {
        assert!(row[0].distance(row[columns]) < 1e-4, "{} goes on as {}", row[columns], row[0]);
    }
}

#[test]
fn shapes_keep_to_their_sizes() {
    let [low, high] = drapery(10.0, 0.5, 6, 40).bounds();
    assert!((low.y + 0.25).abs() < 1e-2 && (high.y - 13.25).abs() < 1e-3, "{low}, {high}");
    assert!((high - low).max_element() < 26.0, "{low}, {high}");
    let [low, high] = bowl(10.0, 2.0, 40).bounds();
    assert!((low.y + 10.0).abs() < 1e-3 && (high.y - 1.0).abs() < 1e-3 && (high.x - 10.0).abs() < 0.1, "{low}, {high}");
    for position in relief(10.0, 5, 60).positions {
        assert!((position.length() - 10.0).abs() < 2.1 / 7.25 * 10.0, "{position}");
    }
}

#[test]
#[should_panic(expected = "touches itself")]
fn a_knot_does_not_touch_itself() {
    let _ = knot(10.0, 5.0, 12);
}
