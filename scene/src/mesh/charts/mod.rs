//! Charts: parts of a surface on which a material lies from one side of a box.
//!
//! Triangles are assigned to the six sides so that little is seen slanted and seams are short (`labels`); about a seam, vertices have
//! shares of both sides (`blend`). It depends on the mesh alone: all techniques take the same shares, linear between vertices.

mod blend;
mod labels;
mod surface;

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
    /// The work of a few hundred passes over the triangles.
    #[must_use]
    pub fn charted(self) -> Self {
        let [low, high] = self.bounds();
        let width_mm = WIDTH * (high - low).max_element();
        let surface = Surface::new(&self);
        let labels = labels(&surface, width_mm);
        let sides = blended(&surface, &labels, width_mm);
        Self { sides: Some(surface.vertex_of.iter().map(|&vertex| sides[vertex as usize]).collect()), ..self }
    }
}

#[cfg(test)]
mod tests;
