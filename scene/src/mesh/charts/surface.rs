//! Triangles of a mesh and their neighbours, whatever vertices are stored several times.

use std::collections::HashMap;

use glam::Vec3;

use crate::mesh::Mesh;

/// Cosine of the angle between normals at one place from which on they are of different surfaces.
const CREASE: f32 = 0.5;
/// Number of a triangle that is none.
pub(super) const NONE: u32 = u32::MAX;

/// Surface of a mesh.
pub(super) struct Surface {
    /// Number of the surface's vertex for every vertex of the mesh.
    pub(super) vertex_of: Vec<u32>,
    /// Positions of the vertices, in mm.
    pub(super) positions: Vec<Vec3>,
    /// Vertices of each triangle.
    pub(super) corners: Vec<[u32; 3]>,
    /// Triangles beyond the edges 0-1, 1-2, 2-0, or [`NONE`].
    pub(super) neighbours: Vec<[u32; 3]>,
    /// Unit normals, zero where there is no area.
    pub(super) normals: Vec<Vec3>,
    /// Areas in mm².
    pub(super) areas: Vec<f32>,
    /// Middles of the triangles, in mm.
    pub(super) middles: Vec<Vec3>,
    /// First of the triangles around each vertex in `around`, and one more entry.
    starts: Vec<u32>,
    around: Vec<u32>,
}

impl Surface {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let (vertex_of, positions) = weld(mesh);
        let corners: Vec<[u32; 3]> =
            mesh.triangles.iter().map(|triangle| triangle.map(|k| vertex_of[k as usize])).collect();
        let at = |triangle: &[u32; 3]| triangle.map(|k| positions[k as usize]);
        // As the vertices' normals say, whichever way the triangles wind.
        let normal = |(triangle, [a, b, c]): (&[u32; 3], [Vec3; 3])| {
            let smooth: Vec3 = triangle.iter().map(|&k| mesh.normals[k as usize]).sum();
            let normal = (b - a).cross(c - a);
            normal.normalize_or_zero() * if normal.dot(smooth) < 0.0 { -1.0 } else { 1.0 }
        };
        let area = |[a, b, c]: [Vec3; 3]| 0.5 * (b - a).cross(c - a).length();
        let mut starts = vec![0_u32; positions.len() + 1];
        for &corner in corners.iter().flatten() {
            starts[corner as usize + 1] += 1;
        }
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let mut next = starts.clone();
        let mut around = vec![0; 3 * corners.len()];
        for (triangle, corners) in (0..).zip(&corners) {
            for &corner in corners {
                around[next[corner as usize] as usize] = triangle;
                next[corner as usize] += 1;
            }
        }
        Self {
            neighbours: neighbours(&corners),
            normals: mesh.triangles.iter().zip(corners.iter().map(at)).map(normal).collect(),
            areas: corners.iter().map(at).map(area).collect(),
            middles: corners.iter().map(at).map(|[a, b, c]| (a + b + c) / 3.0).collect(),
            vertex_of,
            positions,
            corners,
            starts,
            around,
        }
    }

    /// Triangles around a vertex.
    pub(super) fn around(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        &self.around[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }

    /// Length of edge `k` of a triangle, in mm.
    pub(super) fn edge_mm(&self, triangle: usize, k: usize) -> f32 {
        let [a, b] = [k, (k + 1) % 3].map(|k| self.positions[self.corners[triangle][k] as usize]);
        a.distance(b)
    }
}

/// Vertices at one place with like normals made one: its number for every vertex of the mesh, and the positions.
fn weld(mesh: &Mesh) -> (Vec<u32>, Vec<Vec3>) {
    let mut at_place: HashMap<[u32; 3], Vec<u32>> = HashMap::with_capacity(mesh.positions.len());
    let (mut positions, mut normals) = (Vec::new(), Vec::<Vec3>::new());
    let vertices = mesh.positions.iter().zip(&mesh.normals);
    let number = |(position, normal): (&Vec3, &Vec3)| {
        // 0 and -0 are one place.
        let there = at_place.entry((*position + 0.0).to_array().map(f32::to_bits)).or_default();
        if let Some(same) = there.iter().find(|&&same| normals[same as usize].dot(*normal) > CREASE) {
            return *same;
        }
        let number = u32::try_from(positions.len()).expect("meshes have fewer than 2³² vertices");
        there.push(number);
        positions.push(*position);
        normals.push(*normal);
        number
    };
    let vertex_of = vertices.map(number).collect();
    (vertex_of, positions)
}

/// Triangles beyond the three edges of each; of an edge of more than two triangles none are neighbours.
fn neighbours(corners: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let edge = |triangle: usize, k: usize| {
        let [a, b] = [corners[triangle][k], corners[triangle][(k + 1) % 3]];
        ([a.min(b), a.max(b)], triangle, k)
    };
    let mut edges: Vec<_> = (0..corners.len()).flat_map(|triangle| [0, 1, 2].map(|k| edge(triangle, k))).collect();
    edges.sort_unstable();
    let mut neighbours = vec![[NONE; 3]; corners.len()];
    for shared in edges.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, a, at_a), (_, b, at_b)] = *shared {
            let number = |triangle: usize| u32::try_from(triangle).unwrap_or(NONE);
            (neighbours[a][at_a], neighbours[b][at_b]) = (number(b), number(a));
        }
    }
    neighbours
}
