//! Tangents: directions of texture coordinates on a surface.

use glam::{Vec2, Vec3, Vec4};

use super::triangles::Mesh;
use crate::error::{Error, Result};

impl Mesh {
    /// Unit tangents of the vertices along u, across their normals; in the fourth place, 1 if normal × tangent goes
    /// along −v, down the columns of a material, and −1 if up. Means over the triangles around, weighted by area.
    ///
    /// They follow from texture coordinates alone: what a file says of tangents is not needed.
    ///
    /// # Errors
    /// [`Error::Mesh`] if the mesh has no texture coordinates.
    pub fn tangents(&self) -> Result<Vec<Vec4>> {
        let Some(uvs) = &self.uvs else {
            return Err(Error::Mesh("no texture coordinates, which say how a material lies on it".to_owned()));
        };
        let mut along = vec![[Vec3::ZERO; 2]; self.positions.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|k| self.positions[k as usize]);
            let [ta, tb, tc] = triangle.map(|k| uvs[k as usize]);
            let [u, v] = slopes([b - a, c - a], [tb - ta, tc - ta]);
            for k in triangle {
                let of_vertex = &mut along[*k as usize];
                *of_vertex = [of_vertex[0] + u, of_vertex[1] + v];
            }
        }
        let vertices = along.into_iter().zip(&self.normals);
        let tangent = |([u, v], normal): ([Vec3; 2], &Vec3)| {
            let across = (u - normal * u.dot(*normal)).try_normalize();
            // Where texture coordinates do not change, one direction is as good as another.
            let tangent = across.unwrap_or_else(|| normal.any_orthonormal_vector());
            let goes_down = normal.cross(tangent).dot(v) < 0.0;
            tangent.extend(if goes_down { 1.0 } else { -1.0 })
        };
        Ok(vertices.map(tangent).collect())
    }
}

/// Directions in which u and v grow on a triangle of two edges, times twice its area.
fn slopes([e1, e2]: [Vec3; 2], [t1, t2]: [Vec2; 2]) -> [Vec3; 2] {
    let sign = t1.perp_dot(t2).signum();
    let u = (e1 * t2.y - e2 * t1.y) * sign;
    let v = (e2 * t1.x - e1 * t2.x) * sign;
    let area = e1.cross(e2).length();
    [u.normalize_or_zero() * area, v.normalize_or_zero() * area]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{sphere, torus};

    #[test]
    fn tangents_follow_texture_coordinates() {
        // A square that is seen from z, u to the right; v upwards, and downwards.
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from);
        for (v, down) in [(1.0, -1.0), (-1.0, 1.0)] {
            let positions = corners.map(|corner| corner.extend(0.0)).to_vec();
            let uvs = corners.map(|corner| corner * Vec2::new(1.0, v)).to_vec();
            let triangles = vec![[0, 1, 2], [0, 2, 3]];
            let mesh = Mesh::new(positions, Vec::new(), Some(uvs), triangles, 1.0).unwrap();
            for tangent in mesh.tangents().unwrap() {
                assert!((tangent - Vec4::new(1.0, 0.0, 0.0, down)).length() < 1e-6, "{tangent}");
            }
        }
        for mesh in [sphere(5.0, 16), torus(5.0, 2.0, 12)] {
            let tangents = mesh.tangents().unwrap();
            for (tangent, normal) in tangents.iter().zip(&mesh.normals) {
                let tangent = tangent.truncate();
                assert!((tangent.length() - 1.0).abs() < 1e-5 && tangent.dot(*normal).abs() < 1e-5, "{tangent}");
            }
        }
        let bare = Mesh { uvs: None, ..sphere(5.0, 4) };
        assert!(bare.tangents().unwrap_err().to_string().contains("texture coordinates"), "it says why");
    }
}
