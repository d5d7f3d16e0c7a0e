//! Expansion of a factored BTF: codewords and tables are decoded and multiplied out.

use super::coder::RangeDecoder;
use super::evaluate::ExpandedBtf;
use super::model::{IntegerModel, code_core, code_words};
use super::reader::FactoredBtf;
use crate::container::index::row_major;

/// Memory for [`FactoredBtf::expand`].
#[derive(Debug)]
pub struct ExpansionBuffers<'b, 's> {
    /// [`FactoredBtf::table_len`] bytes.
    pub table: &'b mut [i8],
    /// [`FactoredBtf::words_len`] numbers.
    pub words: &'b mut [i16],
    /// [`FactoredBtf::scratch_len`] numbers, free again afterwards.
    pub scratch: &'s mut [f32],
}

impl<'a> FactoredBtf<'a> {
    /// Undoes the entropy coding of codewords and tables, and multiplies the tables out; `None` where a buffer is
    /// shorter than [`Self::table_len`], [`Self::words_len`] and [`Self::scratch_len`] say.
    #[must_use]
    pub fn expand<'b>(&self, buffers: ExpansionBuffers<'b, '_>) -> Option<ExpandedBtf<'b>>
    where
        'a: 'b,
    {
        let table = buffers.table.get_mut(..self.table_len())?;
        let words = buffers.words.get_mut(..self.words_len())?;
        let scratch = buffers.scratch.get_mut(..self.scratch_len())?;
        expand_words(self, words);
        expand_table(self, table, scratch);
        Some(ExpandedBtf::new(self, table, words))
    }
}

fn expand_words(file: &FactoredBtf<'_>, words: &mut [i16]) {
    let mut coder = RangeDecoder::new(file.words);
    let mut rest = words;
    for stage in file.shape().stages() {
        let (of_stage, others) = rest.split_at_mut_checked(stage.numbers()).unwrap_or_default();
        code_words(&mut coder, stage.count.into(), of_stage);
        rest = others;
    }
}

/// Column after column: X[v][l] = Σ_ij A_i[v] G[i][j] B_j[l], in steps of the column.
fn expand_table(file: &FactoredBtf<'_>, table: &mut [i8], scratch: &mut [f32]) {
    let (shape, grid) = (file.shape(), file.catalog().grid());
    let (views, lights) = (grid.view_nodes(), grid.light_nodes());
    let (columns, axes) = (shape.columns(), usize::from(shape.light_axes));
    let (sums, scratch) = scratch.split_at_mut_checked(lights).unwrap_or_default();
    let (core, usual) = scratch.split_at_mut_checked(shape.core_len()).unwrap_or_default();
    usual.fill(0.0);
    let (mut coder, mut numbers) = (RangeDecoder::new(file.core), IntegerModel::default());
    for (column, step) in file.header.core_steps.iter().enumerate() {
        core.fill(0.0);
        code_core(&mut coder, &mut numbers, axes, core, usual);
        for view in 0..views {
            // A_i[v] G[i] summed over i, for all j.
            let mut row = [0.0_f32; 255];
            let of_view = file.view_axes.iter().skip(view).step_by(views.max(1));
            let all = of_view.zip(file.header.view_scales.iter()).zip(core.chunks_exact(axes.max(1)));
            for ((axis, scale), numbers) in all {
                let weight = f32::from(axis.cast_signed()) * scale;
                for (sum, number) in row.iter_mut().zip(numbers) {
                    *sum += weight * number;
                }
            }
            sums.fill(0.0);
            let of_lights = file.light_axes.chunks_exact(lights.max(1));
            for ((axis, scale), value) in of_lights.zip(file.header.light_scales.iter()).zip(row) {
                let weight = scale * value * step;
                for (sum, at) in sums.iter_mut().zip(axis) {
                    *sum += weight * f32::from(at.cast_signed());
                }
            }
            let first = row_major(row_major(view, lights, 0), columns, column);
            let cells = table.get_mut(first..).unwrap_or_default().iter_mut().step_by(columns.max(1));
            for (cell, sum) in cells.zip(sums.iter()) {
                // A half away from zero, and then cut: rounds to the nearest.
                #[allow(clippy::cast_possible_truncation, reason = "clamped")]
                let rounded = (sum + 0.5_f32.copysign(*sum)).clamp(-127.0, 127.0) as i8;
                *cell = rounded;
            }
        }
    }
}
