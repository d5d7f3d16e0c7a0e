//! Triangle meshes, checked once.

mod shapes;
mod tangents;

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use crate::error::{Error, Result};

pub use shapes::{bowl, drapery, knot, relief, sphere, torus};

/// A triangle mesh.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Positions of the vertices, in mm.
    pub positions: Vec<Vec3>,
    /// Unit normals of the vertices.
    pub normals: Vec<Vec3>,
    /// Texture coordinates of the vertices, v upwards, if the mesh has any.
    pub uvs: Option<Vec<Vec2>>,
    /// Vertices of the triangles.
    pub triangles: Vec<[u32; 3]>,
}

/// Subdivision stops rather than make more vertices than this.
const MAX_VERTICES: usize = 4_000_000;

impl Mesh {
    /// Checks indices and numbers, scales positions by `mm_per_unit`, and computes normals where `normals` is empty.
    ///
    /// # Errors
    /// [`Error::Mesh`] if the mesh is empty, an index leads outside, or a number is not finite.
    pub fn new(
        mut positions: Vec<Vec3>,
        normals: Vec<Vec3>,
        uvs: Option<Vec<Vec2>>,
        triangles: Vec<[u32; 3]>,
        mm_per_unit: f32,
    ) -> Result<Self> {
        let wrong = |what: String| Err(Error::Mesh(what));
        if triangles.is_empty() {
            return wrong("no triangles".to_owned());
        }
        if !(mm_per_unit.is_finite() && mm_per_unit > 0.0) {
            return wrong(format!("a scale of {mm_per_unit} mm per unit"));
        }
        if let Some(index) = triangles.iter().flatten().find(|&&index| index as usize >= positions.len()) {
            return wrong(format!("a triangle names vertex {index}, but there are {}", positions.len()));
        }
        if let Some(at) = positions.iter().position(|position| !position.is_finite()) {
            return wrong(format!("vertex {at} is at {}", positions[at]));
        }
        if uvs.as_ref().is_some_and(|uvs| uvs.len() != positions.len() || uvs.iter().any(|uv| !uv.is_finite())) {
            return wrong("texture coordinates that are not finite, or not one for each vertex".to_owned());
        }
        for position in &mut positions {
            *position *= mm_per_unit;
        }
        let given = normals.len() == positions.len() && normals.iter().all(|normal| normal.is_finite());
        let normals = if given { normals } else { smooth_normals(&positions, &triangles) };
        let normals = normals.into_iter().map(|normal| normal.try_normalize().unwrap_or(Vec3::Y)).collect();
        Ok(Self { positions, normals, uvs, triangles })
    }

    /// Lowest and highest corner of the box around all vertices.
    #[must_use]
    pub fn bounds(&self) -> [Vec3; 2] {
        let low = self.positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = self.positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        [low, high]
    }

    /// The mesh scaled so that its longest side is `extent_mm`, its middle at the origin.
    ///
    /// # Errors
    /// [`Error::Mesh`] if it has no extent, or `extent_mm` is not positive.
    pub fn fitted(self, extent_mm: f32) -> Result<Self> {
        let [low, high] = self.bounds();
        let middle = 0.5 * (low + high);
        let positions = self.positions.iter().map(|position| *position - middle).collect();
        let scale = extent_mm / (high - low).max_element();
        Self::new(positions, self.normals, self.uvs, self.triangles, scale)
    }

    /// The mesh with no edge longer than `longest_mm`: long edges are halved until there are none, so that light and
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

    /// A third of the triangles around each vertex, in mm².
    #[must_use]
    pub fn vertex_areas(&self) -> Vec<f32> {
        let mut areas = vec![0.0; self.positions.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|k| self.positions[k as usize]);
            let third = (b - a).cross(c - a).length() / 6.0;
            for &k in triangle {
                areas[k as usize] += third;
            }
        }
        areas
    }

    fn is_long(&self, [a, b]: [u32; 2], longest_mm: f32) -> bool {
        self.positions[a as usize].distance(self.positions[b as usize]) > longest_mm
    }

    /// The vertex in the middle of an edge; both triangles of the edge get the same.
    fn middle(&mut self, [a, b]: [u32; 2], middles: &mut HashMap<[u32; 2], u32>) -> u32 {
        *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let (a, b) = (a as usize, b as usize);
            self.positions.push(0.5 * (self.positions[a] + self.positions[b]));
            let normal = self.normals[a] + self.normals[b];
            self.normals.push(normal.try_normalize().unwrap_or(self.normals[a]));
            if let Some(uvs) = &mut self.uvs {
                uvs.push(0.5 * (uvs[a] + uvs[b]));
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

/// Normals weighted by area.
fn smooth_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|k| positions[k as usize]);
        let normal = (b - a).cross(c - a);
        for &k in triangle {
            normals[k as usize] += normal;
        }
    }
    normals
}

#[cfg(test)]
mod tests {
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

    #[test]
    fn broken_meshes_are_refused() {
        let corner = || vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let new = |positions, triangles| Mesh::new(positions, Vec::new(), None, triangles, 1.0);
        assert!(new(corner(), vec![]).is_err(), "no triangles");
        assert!(new(corner(), vec![[0, 1, 3]]).is_err(), "an index outside");
        assert!(new(vec![Vec3::NAN; 3], vec![[0, 1, 2]]).is_err(), "no number");
        assert_eq!(new(corner(), vec![[0, 1, 2]]).unwrap().normals, [Vec3::Z; 3]);
    }
}
