//! Values of texels, whatever the model of the file.

use super::catalog::{Catalog, Texel};
use super::coord::GridCoord;
use super::factored::ExpandedBtf;
use super::grid::View;
use super::nested::NestedBtf;

/// BTF that can be evaluated: nested codebooks as they stand in their file, or an expanded factored BTF.
pub trait Evaluate {
    /// Header and materials of the file.
    fn catalog(&self) -> &Catalog<'_>;

    /// Value of a texel at coordinates of the grid, as images have it ([`ColourEncoding`](super::ColourEncoding)): π times the radiance under
    /// light of unit irradiance on a plane that faces it, so that white paper has cos θ_i. Not negative.
    #[must_use]
    fn eval_at(&self, texel: Texel, coord: &GridCoord) -> [f32; 3];

    /// [`Self::eval_at`] of texels that follow each other, row by row, level by level; from the last on, values are
    /// those of other texels, or of none.
    fn eval_texels(&self, first: Texel, coord: &GridCoord, values: &mut [[f32; 3]]) {
        let Texel(mut texel) = first;
        for value in values {
            *value = self.eval_at(Texel(texel), coord);
            texel = texel.wrapping_add(1);
        }
    }

    /// [`Self::eval_at`] for a light and a prepared view.
    #[must_use]
    fn eval_for(&self, texel: Texel, light: [f32; 3], view: &View) -> [f32; 3] {
        self.eval_at(texel, &self.catalog().grid().coord_for(light, view))
    }

    /// [`Self::eval_at`] for unit vectors towards light and eye: x along the rows, y down the columns, z the normal.
    #[must_use]
    fn eval(&self, texel: Texel, light: [f32; 3], view: [f32; 3]) -> [f32; 3] {
        self.eval_at(texel, &self.catalog().grid().coord(light, view))
    }
}

impl Evaluate for NestedBtf<'_> {
    fn catalog(&self) -> &Catalog<'_> {
        NestedBtf::catalog(self)
    }

    fn eval_at(&self, texel: Texel, coord: &GridCoord) -> [f32; 3] {
        NestedBtf::eval_at(self, texel, coord)
    }
}

impl Evaluate for ExpandedBtf<'_> {
    fn catalog(&self) -> &Catalog<'_> {
        ExpandedBtf::catalog(self)
    }

    fn eval_at(&self, texel: Texel, coord: &GridCoord) -> [f32; 3] {
        ExpandedBtf::eval_at(self, texel, coord)
    }

    fn eval_texels(&self, first: Texel, coord: &GridCoord, values: &mut [[f32; 3]]) {
        ExpandedBtf::eval_texels(self, first, coord, values);
    }
}
