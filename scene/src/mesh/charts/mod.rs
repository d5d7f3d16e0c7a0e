//! Charts: parts of a surface on which a material lies from one side of a box.
//!
//! Triangles are assigned to the six sides so that little is seen slanted and seams are short (`labels`); about a seam, vertices have
//! shares of both sides (`blend`). It depends on the mesh alone: all techniques take the same shares, linear between vertices.

mod blend;
mod labels;
mod surface;

use glam::Vec3;

use super::triangles::Mesh;
use blend::blended;
use labels::labels;
use surface::Surface;

/// Distance from a seam within which its charts are blended, and length that a seam has to save to be moved by as much, by the longest
/// side of the mesh.
const WIDTH: f32 = 0.025;

impl Mesh {
    /// Mesh with charts for box mapping, which are blended within 2.5 % of its longest side about their seams, or within one edge of
    /// the mesh where edges are longer. Vertices at one place whose normals differ by more than 60° are no neighbours.
    ///
    /// The work of a few hundred passes over the triangles, and of at most 1,024 of them for each vertex about a seam. A mesh that is too
    /// large for numbers of single precision stays without charts.
    #[must_use]
    pub fn charted(self) -> Self {
        // Of what is seen: files may have vertices that belong to no triangle.
        let corners = || self.triangles.iter().flatten().map(|&vertex| self.positions[vertex as usize]);
        let [low, high] = [corners().reduce(Vec3::min), corners().reduce(Vec3::max)].map(Option::unwrap_or_default);
        let width_mm = WIDTH * (high - low).max_element();
        if !width_mm.is_finite() {
            return self;
        }
        let surface = Surface::new(&self);
        let labels = labels(&surface, width_mm);
        let sides = blended(&surface, &labels, width_mm);
        Self { sides: Some(surface.vertex_of.iter().map(|&vertex| sides[vertex as usize]).collect()), ..self }
    }
}

#[cfg(test)]
mod tests;
