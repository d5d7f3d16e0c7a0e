//! Triangle meshes, checked once.

use std::borrow::Cow;

use glam::{Vec2, Vec3};
use subsurf_decoder::container::crc32;

use super::bounds::BoundingSphere;
use crate::error::{Error, Result};
use crate::mapping::BoxSides;

/// Triangle mesh in mm.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Positions of the vertices, in mm.
    pub positions: Vec<Vec3>,
    /// Unit normals of the vertices.
    pub normals: Vec<Vec3>,
    /// Texture coordinates of the vertices, v upwards, if there are any.
    pub uvs: Option<Vec<Vec2>>,
    /// Shares of the sides of the box by which materials lie at the vertices, as [`Mesh::charted`] makes them.
    pub sides: Option<Vec<BoxSides>>,
    /// Numbers of the vertices of each triangle, from 0.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Mesh of `positions` in units of `mm_per_unit` mm, checked. Normals that are zero or not finite become means over the
    /// triangles around, weighted by area; all do if `normals` does not hold one for each vertex.
    ///
    /// # Errors
    /// [`Error::Mesh`] if the mesh is empty or has no area, an index leads outside, or a number is not finite.
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
        if !has_area(&positions, &triangles) {
            return wrong(format!("no area: all of {} triangles are lines or points", triangles.len()));
        }
        let given = if normals.len() == positions.len() { normals } else { vec![Vec3::ZERO; positions.len()] };
        let is_whole = given.iter().all(|normal| normal.try_normalize().is_some());
        let smooth = if is_whole { Vec::new() } else { smooth_normals(&positions, &triangles) };
        let unit = |(k, normal): (usize, &Vec3)| normal.try_normalize().or_else(|| smooth.get(k)?.try_normalize());
        let normals = given.iter().enumerate().map(|normal| unit(normal).unwrap_or(Vec3::Y)).collect();
        Ok(Self { positions, normals, uvs, sides: None, triangles })
    }

    /// Lowest and highest corner of the box around all vertices.
    #[must_use]
    pub fn bounds(&self) -> [Vec3; 2] {
        let low = self.positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = self.positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        [low, high]
    }

    /// Sphere around the middle of [`Mesh::bounds`] that holds all vertices.
    #[must_use]
    pub fn bounding_sphere(&self) -> BoundingSphere {
        let [low, high] = self.bounds();
        let centre_mm = 0.5 * (low + high);
        let radius_mm = self.positions.iter().map(|position| position.distance(centre_mm)).fold(1e-3, f32::max);
        BoundingSphere { centre_mm, radius_mm }
    }

    /// Mesh scaled so that its longest side is `extent_mm`, its middle at the origin.
    ///
    /// # Errors
    /// [`Error::Mesh`] if it has no extent, or `extent_mm` is not positive.
    pub fn fitted(self, extent_mm: f32) -> Result<Self> {
        let [low, high] = self.bounds();
        let middle = 0.5 * (low + high);
        let positions = self.positions.iter().map(|position| *position - middle).collect();
        let scale = extent_mm / (high - low).max_element();
        let sides = self.sides;
        Ok(Self { sides, ..Self::new(positions, self.normals, self.uvs, self.triangles, scale)? })
    }

    /// Shares of the sides of the box by which materials lie at the vertices: those of the charts, or by the normals where the
    /// mesh has no charts.
    #[must_use]
    pub fn sides(&self) -> Cow<'_, [BoxSides]> {
        match &self.sides {
            Some(sides) => Cow::Borrowed(sides),
            None => self.normals.iter().map(|normal| BoxSides::facing(*normal)).collect(),
        }
    }

    /// Length of the side of the texture's unit square on the surface in mm, from the areas of both; 0 where all texture
    /// coordinates are on a line. `None` without texture coordinates.
    #[must_use]
    pub fn mm_per_uv(&self) -> Option<f32> {
        let uvs = self.uvs.as_ref()?;
        let (mut area_mm2, mut area_uv) = (0.0_f64, 0.0_f64);
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|k| self.positions[k as usize]);
            let [ta, tb, tc] = triangle.map(|k| uvs[k as usize]);
            area_mm2 += f64::from((b - a).cross(c - a).length());
            area_uv += f64::from((tb - ta).perp_dot(tc - ta).abs());
        }
        #[allow(clippy::cast_possible_truncation, reason = "a length of single precision")]
        let mm = if area_uv > 0.0 { (area_mm2 / area_uv).sqrt() as f32 } else { 0.0 };
        Some(mm)
    }

    /// This mesh and another as one, where both lie. It has texture coordinates if both have; where one has charts, the other lies
    /// by its normals if it has none.
    ///
    /// # Panics
    /// If they have more than 2³² vertices together.
    #[must_use]
    pub fn with(mut self, other: Self) -> Self {
        let first = u32::try_from(self.positions.len()).expect("fewer than 2³² vertices");
        let have_charts = self.sides.is_some() || other.sides.is_some();
        self.sides = have_charts.then(|| [self.sides(), other.sides()].concat());
        self.positions.extend(other.positions);
        self.normals.extend(other.normals);
        self.uvs = self.uvs.zip(other.uvs).map(|(uvs, more)| [uvs, more].concat());
        let number = |vertex: u32| vertex.checked_add(first).expect("fewer than 2³² vertices");
        self.triangles.extend(other.triangles.into_iter().map(|triangle| triangle.map(number)));
        self
    }

    /// CRC-32 of the positions and of the triangles, as little-endian bytes: what else is precomputed for a mesh is no good to another.
    #[must_use]
    pub fn geometry_crc(&self) -> [u32; 2] {
        let positions: Vec<u8> =
            self.positions.iter().flat_map(|at| at.to_array()).flat_map(f32::to_le_bytes).collect();
        let triangles: Vec<u8> = self.triangles.iter().flatten().flat_map(|k| k.to_le_bytes()).collect();
        [crc32(&positions), crc32(&triangles)]
    }

    /// Area that each vertex stands for, a third of the triangles around it, in mm².
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
}

/// Whether a triangle is more than a line, but for the rounding of its corners.
fn has_area(positions: &[Vec3], triangles: &[[u32; 3]]) -> bool {
    let far = positions.iter().map(|position| position.abs().max_element()).fold(0.0, f32::max);
    let rounding = f64::from(4.0 * f32::EPSILON * far);
    triangles.iter().any(|triangle| {
        let [a, b, c] = triangle.map(|k| positions[k as usize].as_dvec3());
        let (ab, ac) = (b - a, c - a);
        ab.cross(ac).length() > rounding * ab.length().max(ac.length())
    })
}

/// Means of the normals of the triangles around each vertex, weighted by area; not of unit length.
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
