//! What triangles near a place send it: integrals over them in place of sums over their corners.
//!
//! R_d falls so steeply that sums over vertices depend on how a mesh happens to be cut: by 2 % from vertex to vertex of a scan whose vertices
//! are 0.75 mm apart, in marble. Here light is linear between the vertices of a triangle, and R_d is integrated.

use std::collections::HashMap;
use std::f32::consts::TAU;

use glam::Vec3;
use nalgebra::DMatrix;

use super::point_tree::PointTree;
use super::rd_table::RdTable;
use super::surface::Surface;

/// Distances of centroids, in longest edges of the triangle, up to which R_d is taken at the centroids of so many parts along each edge.
const RULES: [(f32, u16); 3] = [(1.5, 4), (3.0, 2), (REACH, 1)];
/// Distance from which corners are as good.
const REACH: f32 = 4.0;
/// Directions, and rings of each, of triangles that have the place as a corner.
const DIRECTIONS: u16 = 4;
const RINGS: u16 = 6;

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
    /// Distances in mm within which each triangle is integrated.
    reaches: Vec<f32>,
    tree: PointTree,
    /// The largest reach of the triangles of each node.
    node_reaches: Vec<f32>,
}

impl<'a> Near<'a> {
    pub(super) fn new(surface: &'a Surface, table: &'a RdTable) -> Self {
        let corners = surface.triangles.iter().map(|triangle| triangle.map(|place| surface.positions[place as usize]));
        let (mut centroids, mut areas, mut reaches) = (Vec::new(), Vec::new(), Vec::new());
        for [a, b, c] in corners {
            centroids.push((a + b + c) / 3.0);
            areas.push(0.5 * (b - a).cross(c - a).length());
            reaches.push(REACH * a.distance(b).max(b.distance(c)).max(c.distance(a)));
        }
        let tree = PointTree::new(&centroids, &areas);
        let mut node_reaches = vec![0.0_f32; tree.nodes.len()];
        for (number, node) in tree.nodes.iter().enumerate().rev() {
            node_reaches[number] = match node.second {
                Some(second) => node_reaches[number + 1].max(node_reaches[second]),
                None => tree.order[node.points.clone()].iter().map(|k| reaches[*k as usize]).fold(0.0, f32::max),
            };
        }
        Self { surface, table, centroids, areas, reaches, tree, node_reaches }
    }

    /// What is to be added to sums over the `places` in a ball for triangles that are near them. Each source then counts as if it were alone
    /// in the sums, but for the places themselves, which count in none.
    pub(super) fn weights(&self, places: &[u32], centre: Vec3, radius: f32, channels: usize) -> NearWeights {
        let triangles = self.around(centre, radius);
        let (mut rows, mut sources) = (HashMap::new(), Vec::new());
        let mut row_of = |source: u32| {
            *rows.entry(source).or_insert_with(|| {
                sources.push(source);
                sources.len() - 1
            })
        };
        let triangles: Vec<(usize, [usize; 3])> =
            triangles.into_iter().map(|number| (number, self.surface.triangles[number].map(&mut row_of))).collect();
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
            for (row, (part, source)) in parts.iter().zip(&sources).enumerate().filter(|(_, (part, _))| part.area > 0.0)
            {
                let [at, from] = [place, source].map(|place| self.surface.positions[*place as usize]);
                let rd = if place == source { [0.0; 3] } else { self.table.at_squared(at.distance_squared(from)) };
                for c in 0..channels {
                    weights[(row, number * channels + c)] =
                        (part.integral[c] - rd[c] * part.area) / self.surface.areas[*source as usize];
                }
            }
        }
        NearWeights { sources, weights }
    }

    /// Triangles that may be near to places in a ball.
    fn around(&self, centre: Vec3, radius: f32) -> Vec<usize> {
        let (mut triangles, mut open) = (Vec::new(), vec![0]);
        while let Some(number) = open.pop() {
            let node = &self.tree.nodes[number];
            if node.centre.distance(centre) > node.radius + radius + self.node_reaches[number] {
                continue;
            }
            match node.second {
                Some(second) => open.extend([second, number + 1]),
                None => triangles.extend(self.tree.order[node.points.clone()].iter().map(|k| *k as usize)),
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
        let distance = at.distance(self.centroids[triangle]) / self.reaches[triangle] * REACH;
        let (_, parts) = RULES.iter().find(|(limit, _)| distance < *limit)?;
        Some(self.over_parts(at, positions, *parts))
    }

    /// ∫ R_d λ_k dA `[k][rgb]` by the centroids of parts of the triangle that are alike.
    fn over_parts(&self, at: Vec3, [a, b, c]: [Vec3; 3], parts: u16) -> [[f32; 3]; 3] {
        let area = 0.5 * (b - a).cross(c - a).length() / f32::from(parts).powi(2);
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
            let length = e_1.lerp(e_2, s).length();
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

    #[test]
    fn sums_do_not_depend_on_how_a_mesh_is_cut() {
        // Vertices at random, as scans have them; then the same surface in smaller triangles.
        let mut mesh = knot(20.0, 6.0, 24).fitted(40.0).unwrap();
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
