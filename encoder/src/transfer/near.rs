//! What triangles near a place send it: integrals over them in place of sums over their corners.
//!
//! R_d falls so steeply that sums over vertices depend on how a mesh happens to be cut: by 2 % rms from vertex to vertex of a scan whose
//! vertices are 0.75 mm apart, in marble. Here light is linear between the vertices of a triangle, and R_d is integrated.

use std::collections::HashMap;
use std::f32::consts::TAU;

use glam::Vec3;
use nalgebra::DMatrix;

use super::point_tree::PointTree;
use super::rd_table::RdTable;
use super::surface::Surface;

/// Distances of centroids, in edges of the triangle, up to which R_d is taken at the centroids of so many parts along each edge.
const RULES: [(f32, u16); 3] = [(1.5, 4), (3.0, 2), (REACH, 1)];
/// Distance from which corners are as good.
const REACH: f32 = 4.0;
/// The edge of a triangle is its longest one, but at most so many of an equilateral triangle of its area: so not many thin ones are near.
const THIN: f32 = 3.0;
/// Most times as many parts along each edge of a triangle, where edges are longer than twice the radius within which half of the light leaves.
const MOST_FINER: u16 = 4;
/// Directions, and rings of each, of triangles that have the place as a corner.
const DIRECTIONS: u16 = 4;
const RINGS: u16 = 6;

/// Shortest distance to the edge across from a corner, by the other two edges: nearer, differences of the tail are rounding.
const SHORTEST: f32 = 1e-3;

/// Weights of sources for the places of a leaf.
pub(super) struct NearWeights {
    /// Places whose flux counts.
    pub(super) sources: Vec<u32>,
    /// What their flux is multiplied by, `[source × channel + channels · place]`.
    pub(super) weights: DMatrix<f32>,
}

/// What triangles near a place add to one of their corners.
#[derive(Clone, Copy, Default)]
struct Part {
    /// ∫ R_d λ dA `[rgb]`.
    integral: [f32; 3],
    /// Their thirds in mm².
    area: f32,
}

/// Triangles of a surface, to be found by their distance.
pub(super) struct Near<'a> {
    surface: &'a Surface,
    table: &'a RdTable,
    centroids: Vec<Vec3>,
    areas: Vec<f32>,
    /// Edges in mm by which distances of each triangle count.
    edges: Vec<f32>,
    /// Radius in mm within which half of the light leaves.
    half_radius_mm: f32,
    tree: PointTree,
    /// Distances in mm from which the triangles of each node are far.
    reaches: Vec<f32>,
    /// Numbers of the triangles around each place.
    around: Vec<Vec<u32>>,
}

impl<'a> Near<'a> {
    pub(super) fn new(surface: &'a Surface, table: &'a RdTable) -> Self {
        let (mut centroids, mut areas, mut edges, mut reaches) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for triangle in &surface.triangles {
            let [a, b, c] = triangle.map(|place| surface.positions[place as usize]);
            let area = 0.5 * (b - a).cross(c - a).length();
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            let edge = longest.min(THIN * (4.0 * area / 3.0_f32.sqrt()).sqrt());
            centroids.push((a + b + c) / 3.0);
            areas.push(area);
            edges.push(edge);
            // Nothing of a triangle arrives from beyond the radius of R_d.
            reaches.push((REACH * edge).min(table.radius_mm + longest));
        }
        let tree = PointTree::new(&centroids, &areas);
        let mut of_nodes = vec![0.0_f32; tree.nodes.len()];
        for (number, node) in tree.nodes.iter().enumerate().rev() {
            of_nodes[number] = match node.second {
                Some(second) => of_nodes[number + 1].max(of_nodes[second]),
                None => tree.order[node.points.clone()].iter().map(|k| reaches[*k as usize]).fold(0.0, f32::max),
            };
        }
        let mut around = vec![Vec::new(); surface.len()];
        for (number, triangle) in (0..).zip(&surface.triangles) {
            triangle.iter().for_each(|place| around[*place as usize].push(number));
        }
        let half_radius_mm = table.half_radius_mm();
        Self { surface, table, centroids, areas, edges, half_radius_mm, tree, reaches: of_nodes, around }
    }

    /// What is to be added for triangles near the `places` in a ball to sums over all other places, R_d(‖x_i − x_o‖) Φ_i: their integrals, less what
    /// those sums have of them.
    pub(super) fn weights(&self, places: &[u32], centre: Vec3, radius: f32, channels: usize) -> NearWeights {
        let mut triangles = self.within(centre, radius);
        places.iter().for_each(|place| triangles.extend(&self.around[*place as usize]));
        triangles.sort_unstable();
        triangles.dedup();
        let (mut rows, mut sources) = (HashMap::new(), Vec::new());
        let mut row_of = |source: u32| {
            *rows.entry(source).or_insert_with(|| {
                sources.push(source);
                sources.len() - 1
            })
        };
        let triangles: Vec<(usize, [usize; 3])> = triangles
            .into_iter()
            .map(|number| number as usize)
            .map(|number| (number, self.surface.triangles[number].map(&mut row_of)))
            .collect();
        let mut weights = DMatrix::zeros(sources.len(), places.len() * channels);
        let mut parts = vec![Part::default(); sources.len()];
        for (number, place) in places.iter().enumerate() {
            parts.fill(Part::default());
            for (triangle, rows) in &triangles {
                let Some(integrals) = self.integrals(*place, *triangle) else { continue };
                for (row, integral) in rows.iter().zip(integrals) {
                    // A third of the triangle is of each corner.
                    parts[*row].area += self.areas[*triangle] / 3.0;
                    parts[*row].integral = [0, 1, 2].map(|c| parts[*row].integral[c] + integral[c]);
                }
            }
            for (row, (part, source)) in parts.iter().zip(&sources).enumerate() {
                let of_source = self.surface.areas[*source as usize];
                if part.area <= 0.0 || of_source <= 0.0 {
                    continue;
                }
                let [at, from] = [place, source].map(|place| self.surface.positions[*place as usize]);
                let rd = if place == source { [0.0; 3] } else { self.table.at_squared(at.distance_squared(from)) };
                for c in 0..channels {
                    weights[(row, number * channels + c)] = (part.integral[c] - rd[c] * part.area) / of_source;
                }
            }
        }
        NearWeights { sources, weights }
    }

    /// Triangles whose middle may be near to places in a ball.
    fn within(&self, centre: Vec3, radius: f32) -> Vec<u32> {
        let (mut triangles, mut open) = (Vec::new(), vec![0]);
        while let Some(number) = open.pop() {
            let node = &self.tree.nodes[number];
            if node.centre.distance(centre) > node.radius + radius + self.reaches[number] {
                continue;
            }
            match node.second {
                Some(second) => open.extend([second, number + 1]),
                None => triangles.extend(&self.tree.order[node.points.clone()]),
            }
        }
        triangles
    }

    /// ∫ R_d λ_k dA `[k][rgb]` over a triangle as a place sees it, λ_k its barycentric coordinates. `None` of triangles that are far, or have no
    /// area.
    fn integrals(&self, place: u32, triangle: usize) -> Option<[[f32; 3]; 3]> {
        if self.areas[triangle] <= 0.0 {
            return None;
        }
        let corners = self.surface.triangles[triangle];
        let positions = corners.map(|place| self.surface.positions[place as usize]);
        if let Some(own) = corners.iter().position(|corner| *corner == place) {
            return Some(self.around_corner(positions, own));
        }
        let at = self.surface.positions[place as usize];
        let (distance, edge) = (at.distance(self.centroids[triangle]), self.edges[triangle]);
        let (_, parts) = RULES.iter().find(|(limit, _)| distance < limit * edge)?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let finer = ((edge / (2.0 * self.half_radius_mm)).ceil() as u16).clamp(1, MOST_FINER);
        Some(self.over_parts(at, positions, self.areas[triangle], parts * finer))
    }

    /// ∫ R_d λ_k dA `[k][rgb]` by the centroids of parts of the triangle that are alike.
    fn over_parts(&self, at: Vec3, [a, b, c]: [Vec3; 3], area: f32, parts: u16) -> [[f32; 3]; 3] {
        let area = area / f32::from(parts).powi(2);
        let mut sums = [[0.0; 3]; 3];
        let mut add = |u: f32, v: f32| {
            let [u, v] = [u, v].map(|coordinate| coordinate / f32::from(parts));
            let rd = self.table.at_squared(at.distance_squared(a + u * (b - a) + v * (c - a)));
            for (sum, lambda) in sums.iter_mut().zip([1.0 - u - v, u, v]) {
                *sum = std::array::from_fn(|c| sum[c] + area * lambda * rd[c]);
            }
        };
        for i in 0..parts {
            for j in 0..parts - i {
                let [i, j] = [i, j].map(f32::from);
                add(i + 1.0 / 3.0, j + 1.0 / 3.0);
                // The part between this one and the next in both directions.
                if i + j + 1.0 < f32::from(parts) {
                    add(i + 2.0 / 3.0, j + 2.0 / 3.0);
                }
            }
        }
        sums
    }

    /// ∫ R_d λ_k dA `[k][rgb]` for a place in a corner: x = ρ (e_1 + s (e_2 − e_1)) from there, dA = 2 |T| ρ dρ ds, where
    /// ∫ R_d ρ dρ of a ring is the difference of the tail T at its ends by 2π ‖x / ρ‖².
    fn around_corner(&self, positions: [Vec3; 3], own: usize) -> [[f32; 3]; 3] {
        let [next, last] = [(own + 1) % 3, (own + 2) % 3];
        let [e_1, e_2] = [next, last].map(|k| positions[k] - positions[own]);
        let double_area = e_1.cross(e_2).length();
        let mut sums = [[0.0; 3]; 3];
        for direction in 0..DIRECTIONS {
            let s = (f32::from(direction) + 0.5) / f32::from(DIRECTIONS);
            let length = e_1.lerp(e_2, s).length().max(SHORTEST * e_1.length().max(e_2.length()));
            let factor = double_area / (TAU * length * length * f32::from(DIRECTIONS));
            let (mut inner, mut rho) = (self.table.reflectance(), 0.0);
            for ring in 1..=RINGS {
                // Narrow near the place, where R_d is steep.
                let end = (f32::from(ring) / f32::from(RINGS)).powi(2);
                let (outer, middle) = (self.table.tail_at(end * length), 0.5 * (rho + end));
                for (k, lambda) in [(own, 1.0 - middle), (next, middle * (1.0 - s)), (last, middle * s)] {
                    sums[k] = std::array::from_fn(|c| sums[k][c] + factor * lambda * (inner[c] - outer[c]));
                }
                (inner, rho) = (outer, end);
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;
    use subsurf_scene::{Mesh, knot};

    use super::*;
    use crate::kernel::Profile;
    use crate::simulate::diffusion::Medium;
    use crate::transfer::gather::Gather;

    /// What leaves at each vertex where as much enters everywhere.
    fn exitance(mesh: &Mesh) -> Vec<f32> {
        let table = RdTable::of(&Profile::dipole(&Medium::measured("marble").unwrap(), 1.5).unwrap()).unwrap();
        let surface = Surface::new(mesh);
        let flux = DMatrix::from_row_slice(1, surface.len(), &surface.areas);
        let sums = Gather::new(&surface, &flux, &table, 1).hierarchical(0.05, &());
        surface.place_of.iter().map(|place| sums[*place as usize]).collect()
    }

    /// Plane of so many cells of `cell_mm`, in two triangles each, whose vertices are moved at random by up to a quarter of a cell.
    fn plane(cell_mm: [f32; 2], cells: [u32; 2]) -> Mesh {
        let mut rng = Pcg64::seed_from_u64(5);
        let [columns, rows] = cells.map(|cells| cells + 1);
        let mut positions = Vec::new();
        for (y, x) in (0..rows).flat_map(|y| (0..columns).map(move |x| (y, x))) {
            let [x, y] = [(x, cell_mm[0]), (y, cell_mm[1])]
                .map(|(k, cell)| (k as f32 + 0.5 * (rng.random::<f32>() - 0.5)) * cell);
            positions.push(Vec3::new(x, 0.0, y));
        }
        let corner = |x: u32, y: u32| y * columns + x;
        let cells = (0..rows - 1).flat_map(|y| (0..columns - 1).map(move |x| (x, y)));
        let triangles = cells.flat_map(|(x, y)| {
            let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x, y + 1), corner(x + 1, y + 1)];
            [[a, c, b], [b, c, d]]
        });
        let normals = vec![Vec3::Y; positions.len()];
        Mesh { normals, positions, uvs: None, sides: None, triangles: triangles.collect() }
    }

    #[test]
    fn light_that_rises_along_a_plane_leaves_as_it_enters() {
        // R_d of all channels ends at 3 mm, red is the narrowest.
        let tail = |k: u16, power: i32| (1.0 - (f32::from(k) / 255.0).powi(4)).powi(power);
        let table = RdTable::of_tail(3.0, (0..=255).map(|k| [12, 6, 3].map(|power| tail(k, power))).collect());
        for (cell_mm, cells) in [([0.4, 0.4], [25, 25]), ([0.15, 0.8], [66, 12]), ([1.2, 0.2], [8, 50])] {
            let mesh = plane(cell_mm, cells);
            let surface = Surface::new(&mesh);
            let light = |at: Vec3| 1.0 + 0.3 * at.x - 0.05 * at.z;
            let entered = surface.positions.iter().zip(&surface.areas).map(|(at, area)| light(*at) * area);
            let flux = DMatrix::from_row_iterator(1, surface.len(), entered);
            let sums = Gather::new(&surface, &flux, &table, 3).hierarchical(0.05, &());
            let inner = (0..surface.len()).filter(|k| {
                let at = surface.positions[*k];
                [at.x, at.z].into_iter().all(|x| (4.0..6.0).contains(&x))
            });
            let mut worst = [0.0_f32; 3];
            for k in inner {
                let expected = light(surface.positions[k]);
                for c in 0..3 {
                    worst[c] = worst[c].max((sums[(c, k)] / expected - 1.0).abs());
                }
            }
            println!("cells of {cell_mm:?} mm: {worst:?}");
            assert!(worst.iter().all(|worst| (1e-9..0.02).contains(worst)), "cells of {cell_mm:?} mm: {worst:?}");
        }
    }

    #[test]
    fn thin_triangles_and_corners_on_edges_do_no_harm() {
        // A corner on the edge across from it, at each place where a direction may go: with area by rounding alone.
        for k in 0..=16_u8 {
            let s = f32::from(k) / 16.0;
            let mut mesh = plane([1.0, 1.0], [6, 6]);
            let first = u32::try_from(mesh.positions.len()).unwrap();
            let [a, b] = [Vec3::new(0.1, 2.0, 0.3), Vec3::new(5.3, 2.1, 4.9)];
            mesh.positions.extend([a, b, a.lerp(b, s)]);
            mesh.normals.extend([Vec3::Y; 3]);
            mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, 8]]);
            let found = exitance(&mesh);
            assert!(found.iter().all(|q| q.is_finite() && (0.0..3.0).contains(q)), "{s}: {found:?}");
        }
    }

    #[test]
    fn sums_do_not_depend_on_how_a_mesh_is_cut() {
        // Vertices at random, as scans have them; then the same surface in smaller triangles.
        let mut mesh = knot(10.0, 3.0, 12).fitted(20.0).unwrap();
        let mut rng = Pcg64::seed_from_u64(3);
        mesh.positions.iter_mut().for_each(|at| *at += 0.5 * Vec3::from([(); 3].map(|()| rng.random::<f32>() - 0.5)));
        let coarse = exitance(&mesh);
        let fine = exitance(&mesh.clone().subdivided(0.5).unwrap());
        let differences = coarse.iter().zip(&fine).map(|(coarse, fine)| f64::from(coarse / fine - 1.0));
        let (mut mean, mut square) = (0.0, 0.0);
        differences.for_each(|difference| (mean, square) = (mean + difference, square + difference * difference));
        let count = coarse.len() as f64;
        let (mean, rms) = (mean / count, (square / count).sqrt());
        println!("{} and {} vertices: mean {mean:.2e}, rms {rms:.2e}", coarse.len(), fine.len());
        assert!(mean.abs() < 1e-3 && rms < 3e-3, "mean {mean:.2e}, rms {rms:.2e}");
    }
}
