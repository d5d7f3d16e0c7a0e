//! Shares of sides at vertices: one far from seams, several about them.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashSet};

use glam::Vec3;

use super::surface::Surface;
use crate::mapping::BoxSides;

/// Distance by which triangles around a vertex count at most, by the width: those of coarse meshes count at all.
const FURTHEST: f32 = 0.8;
/// Path along edges, by the straight distance, at most.
const DETOUR: f32 = 1.5;

/// Shares at every vertex: of the labels of the triangles within `width_mm` on connected surface, by their area and nearness.
pub(super) fn blended(surface: &Surface, labels: &[u8], width_mm: f32) -> Vec<BoxSides> {
    let label_of = |vertex: u32| surface.around(vertex).first().map_or(0, |&triangle| labels[triangle as usize]);
    let vertices = 0..u32::try_from(surface.positions.len()).expect("meshes have fewer than 2³² vertices");
    let mut sides: Vec<BoxSides> = vertices.map(|vertex| of_label(label_of(vertex))).collect();
    let mut seen = HashSet::new();
    for vertex in near_seams(surface, labels, DETOUR * width_mm) {
        sides[vertex as usize] = shares(surface, labels, vertex, width_mm, &mut seen);
    }
    sides
}

/// Share of 1 of one side.
fn of_label(label: u8) -> BoxSides {
    let mut shares = Vec3::ZERO;
    shares[usize::from(label % 3)] = if label < 3 { 1.0 } else { -1.0 };
    BoxSides::new(shares)
}

/// Entry of the search: nearest first.
#[derive(PartialEq)]
struct Open {
    path_mm: f32,
    vertex: u32,
}

impl Eq for Open {}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        other.path_mm.total_cmp(&self.path_mm).then(self.vertex.cmp(&other.vertex))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Vertices from which a seam is at most `reach_mm` away along edges, and those of seams.
fn near_seams(surface: &Surface, labels: &[u8], reach_mm: f32) -> Vec<u32> {
    let is_on_seam = |vertex: &u32| {
        let mut of_triangles = surface.around(*vertex).iter().map(|&triangle| labels[triangle as usize]);
        let first = of_triangles.next();
        of_triangles.any(|label| Some(label) != first)
    };
    let vertices = 0..u32::try_from(surface.positions.len()).expect("meshes have fewer than 2³² vertices");
    let mut nearest = vec![f32::INFINITY; surface.positions.len()];
    let mut open: BinaryHeap<Open> = vertices.filter(is_on_seam).map(|vertex| Open { path_mm: 0.0, vertex }).collect();
    let mut found = Vec::new();
    for seam in &open {
        nearest[seam.vertex as usize] = 0.0;
    }
    while let Some(Open { path_mm, vertex }) = open.pop() {
        if path_mm > nearest[vertex as usize] {
            continue;
        }
        found.push(vertex);
        for &triangle in surface.around(vertex) {
            for other in surface.corners[triangle as usize] {
                let step = surface.positions[vertex as usize].distance(surface.positions[other as usize]);
                let path_mm = path_mm + step;
                if path_mm <= reach_mm && path_mm < nearest[other as usize] {
                    nearest[other as usize] = path_mm;
                    open.push(Open { path_mm, vertex: other });
                }
            }
        }
    }
    found
}

/// Triangles that a vertex looks at, at most, the nearest ones first: fine scans are blended over less than the width.
const MOST: usize = 1024;

/// Shares at a vertex; `seen` is room for the search.
fn shares(surface: &Surface, labels: &[u8], vertex: u32, width_mm: f32, seen: &mut HashSet<u32>) -> BoxSides {
    let centre = surface.positions[vertex as usize];
    let mut of_labels = [0.0_f32; 6];
    let mut open: Vec<u32> = surface.around(vertex).to_vec();
    seen.clear();
    seen.extend(&open);
    let first = open.len();
    let mut at = 0;
    while let Some(&triangle) = open.get(at).filter(|_| at < MOST) {
        let k = triangle as usize;
        let mut distance = surface.middles[k].distance(centre) / width_mm;
        if at < first {
            distance = distance.min(FURTHEST);
        }
        at += 1;
        if distance >= 1.0 {
            continue;
        }
        of_labels[usize::from(labels[k])] += surface.areas[k] * (1.0 - distance * distance).powi(2);
        open.extend(surface.neighbours[k].iter().filter(|&&other| other != super::surface::NONE && seen.insert(other)));
    }
    let total: f32 = of_labels.iter().sum();
    if total <= 0.0 {
        return of_label(labels[surface.around(vertex)[0] as usize]);
    }
    // Opposite sides have a share together, of the greater of them: they are not blended.
    let share = |axis: usize| {
        let [ahead, behind] = [of_labels[axis], of_labels[axis + 3]];
        (ahead + behind) / total * if ahead >= behind { 1.0 } else { -1.0 }
    };
    BoxSides::new(Vec3::from_array([0, 1, 2].map(share)))
}
