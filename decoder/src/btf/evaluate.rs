//! What gives the values of texels, whatever the model of its file.

use super::catalog::{Catalog, Texel};
use super::factored::Expanded;
use super::grid::{Cell, View};
use super::nested::Btf;

/// Nested codebooks as they stand in their file, or expanded factors.
pub trait Evaluate {
    /// Header and materials of the file.
    fn catalog(&self) -> &Catalog<'_>;

    /// Value of a texel at a place of the grid, as images have it ([`Tone`](super::Tone)): π times the radiance under
    /// light of unit irradiance on a plane that faces it, so that white paper has cos θ_i. Not negative.
    #[must_use]
    fn eval_cell(&self, texel: Texel, cell: &Cell) -> [f32; 3];

    /// [`Self::eval_cell`] of texels that follow each other, row by row, level by level; from the last on, values are
    /// those of other texels, or of none.
    fn eval_texels(&self, first: Texel, cell: &Cell, values: &mut [[f32; 3]]) {
        let Texel(mut texel) = first;
        for value in values {
            *value = self.eval_cell(Texel(texel), cell);
            texel = texel.wrapping_add(1);
        }
    }

    /// [`Self::eval_cell`] for a light and a prepared view.
    #[must_use]
    fn eval_for(&self, texel: Texel, light: [f32; 3], view: &View) -> [f32; 3] {
        self.eval_cell(texel, &self.catalog().grid().cell(light, view))
    }

    /// [`Self::eval_cell`] for unit vectors towards light and eye: x along the rows, y down the columns, z the normal.
    #[must_use]
    fn eval(&self, texel: Texel, light: [f32; 3], view: [f32; 3]) -> [f32; 3] {
        self.eval_cell(texel, &self.catalog().grid().pair(light, view))
    }
}

impl Evaluate for Btf<'_> {
    fn catalog(&self) -> &Catalog<'_> {
        Btf::catalog(self)
    }

    fn eval_cell(&self, texel: Texel, cell: &Cell) -> [f32; 3] {
        Btf::eval_cell(self, texel, cell)
    }
}

impl Evaluate for Expanded<'_> {
    fn catalog(&self) -> &Catalog<'_> {
        Expanded::catalog(self)
    }

    fn eval_cell(&self, texel: Texel, cell: &Cell) -> [f32; 3] {
        Expanded::eval_cell(self, texel, cell)
    }

    fn eval_texels(&self, first: Texel, cell: &Cell, values: &mut [[f32; 3]]) {
        Expanded::eval_texels(self, first, cell, values);
    }
}
