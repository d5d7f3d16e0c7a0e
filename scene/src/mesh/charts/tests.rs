use std::collections::HashMap;

use glam::{Vec3, Vec3Swizzles};

use super::*;
use crate::mapping::BoxSides;
use crate::mesh::{knot, relief};

fn bare(mesh: Mesh) -> Mesh {
    Mesh { uvs: None, ..mesh }
}

/// Labels of a mesh, and its surface.
fn labelled(mesh: &Mesh) -> (Surface, Vec<u8>) {
    let [low, high] = mesh.bounds();
    let surface = Surface::new(mesh);
    let labels = labels(&surface, WIDTH * (high - low).max_element());
    (surface, labels)
}

#[test]
fn charts_are_few_and_large() {
    for (mesh, most) in [(bare(relief(20.0, 8, 60)), 16), (bare(knot(20.0, 6.0, 24)), 60)] {
        let (surface, labels) = labelled(&mesh);
        // Union of triangles beside each other that have one label.
        let mut root: Vec<usize> = (0..labels.len()).collect();
        fn top(root: &mut [usize], mut k: usize) -> usize {
            while root[k] != k {
                root[k] = root[root[k]];
                k = root[k];
            }
            k
        }
        for (triangle, around) in surface.neighbours.iter().enumerate() {
            for other in around.iter().map(|&other| other as usize) {
                if labels.get(other) == Some(&labels[triangle]) {
                    let (a, b) = (top(&mut root, triangle), top(&mut root, other));
                    root[a] = b;
                }
            }
        }
        let mut areas: HashMap<usize, f32> = HashMap::new();
        for triangle in 0..labels.len() {
            *areas.entry(top(&mut root, triangle)).or_default() += surface.areas[triangle];
        }
        // Triangles at poles are lines.
        areas.retain(|_, area| *area > 0.0);
        let total: f32 = areas.values().sum();
        assert!((6..=most).contains(&areas.len()), "{} charts", areas.len());
        let least = areas.values().copied().fold(f32::INFINITY, f32::min);
        assert!(least > 2e-3 * total, "an island of {least} of {total} mm²");
    }
}

#[test]
fn neighbours_of_different_sides_are_blended() {
    let mesh = bare(relief(20.0, 8, 120)).charted();
    let sides = mesh.sides.as_ref().unwrap();
    let mut blended = 0;
    for [a, b, c] in &mesh.triangles {
        for [a, b] in [[a, b], [b, c], [c, a]] {
            let [a, b] = [a, b].map(|&k| sides[k as usize].shares());
            // From one side to the other in several steps.
            assert!((a - b).abs().max_element() < 0.75, "{a} beside {b}");
            blended += usize::from(a.abs().max_element() < 0.99);
        }
    }
    let share = blended as f64 / (3 * mesh.triangles.len()) as f64;
    assert!((0.02..0.4).contains(&share), "{share} of it is blended");
    // Vertices at one place have the same shares.
    let places = mesh.positions.iter().map(|p| p.to_array().map(f32::to_bits)).zip(sides);
    let mut at: HashMap<[u32; 3], BoxSides> = HashMap::new();
    assert!(places.into_iter().all(|(place, sides)| *at.entry(place).or_insert(*sides) == *sides), "along the cut");
}

#[test]
fn sharp_edges_are_not_blended_and_sides_are_the_faces() {
    let corners = |normal: Vec3| {
        let [u, v] = [normal.yzx(), normal.zxy()].map(Vec3::abs);
        [-u - v, u - v, u + v, v - u].map(|across| normal + across)
    };
    let faces = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
    let positions = faces.into_iter().flat_map(corners).collect();
    let normals: Vec<Vec3> = faces.into_iter().flat_map(|normal| [normal; 4]).collect();
    let triangles = (0..6).flat_map(|face| [[0, 1, 2], [0, 2, 3]].map(|t: [u32; 3]| t.map(|k| 4 * face + k))).collect();
    let cube = Mesh::new(positions, normals.clone(), None, triangles, 1.0).unwrap().charted();
    let shares: Vec<Vec3> = cube.sides().iter().map(|sides| sides.shares()).collect();
    assert_eq!(shares, normals);
}
