//! Meshes made finer, so that light and material are sampled finely enough on large triangles.

use std::collections::HashMap;

use super::triangles::Mesh;
use crate::error::{Error, Result};

/// Most vertices that subdivision makes.
const MAX_VERTICES: usize = 4_000_000;

impl Mesh {
    /// Mesh with no edge longer than `longest_mm`: long edges are halved until there are none, so that light and
    /// material are sampled finely enough on large triangles. Positions stay on the given triangles.
    ///
    /// # Errors
    /// [`Error::Mesh`] if that takes more than four million vertices.
    pub fn subdivided(mut self, longest_mm: f32) -> Result<Self> {
        loop {
            let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
            let mut triangles = Vec::with_capacity(self.triangles.len());
            for triangle in std::mem::take(&mut self.triangles) {
                let middle = [0, 1, 2].map(|k| {
                    let edge = [triangle[k], triangle[(k + 1) % 3]];
                    self.is_long(edge, longest_mm).then(|| self.middle(edge, &mut middles))
                });
                split(triangle, middle, &mut triangles);
            }
            self.triangles = triangles;
            if middles.is_empty() {
                return Ok(self);
            }
            if self.positions.len() > MAX_VERTICES {
                return Err(Error::Mesh(format!(
                    "edges of at most {longest_mm} mm take more than {MAX_VERTICES} vertices; draw the mesh smaller, or a \
                     material of larger pixels"
                )));
            }
        }
    }

    fn is_long(&self, [a, b]: [u32; 2], longest_mm: f32) -> bool {
        self.positions[a as usize].distance(self.positions[b as usize]) > longest_mm
    }

    /// Number of the vertex in the middle of an edge; both triangles of the edge get the same.
    fn middle(&mut self, [a, b]: [u32; 2], middles: &mut HashMap<[u32; 2], u32>) -> u32 {
        *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let (a, b) = (a as usize, b as usize);
            self.positions.push(0.5 * (self.positions[a] + self.positions[b]));
            let normal = self.normals[a] + self.normals[b];
            self.normals.push(normal.try_normalize().unwrap_or(self.normals[a]));
            if let Some(uvs) = &mut self.uvs {
                uvs.push(0.5 * (uvs[a] + uvs[b]));
            }
            if let Some(sides) = &mut self.sides {
                sides.push(sides[a].middle(sides[b]));
            }
            u32::try_from(self.positions.len() - 1).expect("subdivision stops long before 2³² vertices")
        })
    }
}

/// Splits a triangle at the given middles of its edges 0-1, 1-2, 2-0.
fn split([a, b, c]: [u32; 3], middle: [Option<u32>; 3], out: &mut Vec<[u32; 3]>) {
    match middle {
        [None, None, None] => out.push([a, b, c]),
        [Some(ab), None, None] => out.extend([[a, ab, c], [ab, b, c]]),
        [None, Some(bc), None] => out.extend([[a, b, bc], [a, bc, c]]),
        [None, None, Some(ca)] => out.extend([[a, b, ca], [b, c, ca]]),
        [Some(ab), Some(bc), None] => out.extend([[a, ab, c], [ab, bc, c], [ab, b, bc]]),
        [None, Some(bc), Some(ca)] => out.extend([[a, b, ca], [b, bc, ca], [bc, c, ca]]),
        [Some(ab), None, Some(ca)] => out.extend([[a, ab, ca], [ab, b, ca], [b, c, ca]]),
        [Some(ab), Some(bc), Some(ca)] => out.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]),
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn square(side: f32) -> Mesh {
        let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0) * side);
        Mesh::new(positions.to_vec(), Vec::new(), None, vec![[0, 1, 2], [0, 2, 3]], 1.0).unwrap()
    }

    #[test]
    fn subdivision_keeps_the_area_and_leaves_no_long_edge() {
        for longest in [3.0, 1.0, 0.4] {
            let mesh = square(2.0).subdivided(longest).unwrap();
            let mut area = 0.0;
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.map(|k| mesh.positions[k as usize]);
                area += 0.5 * (b - a).cross(c - a).z;
                let edges = [a.distance(b), b.distance(c), c.distance(a)];
                assert!(edges.iter().all(|edge| *edge <= longest), "{edges:?} > {longest}");
            }
            assert!((area - 4.0_f32).abs() < 1e-4, "{area}");
        }
        assert!(square(1e6).subdivided(1e-3).is_err(), "more vertices than memory");
    }
}
