//! From what is small to what is at hand: codewords and tables.

use super::coder::Decoder;
use super::evaluate::Expanded;
use super::model::{Numbers, code_core, code_words};
use super::reader::Factored;

/// Memory for [`Factored::expand`].
#[derive(Debug)]
pub struct Buffers<'b, 's> {
    /// [`Factored::table_len`] bytes.
    pub table: &'b mut [i8],
    /// [`Factored::words_len`] numbers.
    pub words: &'b mut [i16],
    /// [`Factored::scratch_len`] numbers, free again afterwards.
    pub scratch: &'s mut [f32],
}

pub(super) fn expand<'b>(file: &Factored<'b>, buffers: Buffers<'b, '_>) -> Option<Expanded<'b>> {
    let table = buffers.table.get_mut(..file.table_len())?;
    let words = buffers.words.get_mut(..file.words_len())?;
    let scratch = buffers.scratch.get_mut(..file.scratch_len())?;
    expand_words(file, words);
    expand_table(file, table, scratch);
    Some(Expanded::new(file, table, words))
}

fn expand_words(file: &Factored<'_>, words: &mut [i16]) {
    let mut coder = Decoder::new(file.words);
    let mut rest = words;
    for stage in file.shape().stages() {
        let (of_stage, others) = rest.split_at_mut_checked(stage.numbers()).unwrap_or_default();
        code_words(&mut coder, stage.count.into(), of_stage);
        rest = others;
    }
}

/// Column after column: X[v][l] = Σ_ij A_i[v] G[i][j] B_j[l], in steps of the column.
fn expand_table(file: &Factored<'_>, table: &mut [i8], scratch: &mut [f32]) {
    let (shape, grid) = (file.shape(), file.catalog().grid());
    let (views, lights) = (grid.view_nodes(), grid.light_nodes());
    let (columns, axes) = (shape.columns(), usize::from(shape.light_axes));
    let (sums, scratch) = scratch.split_at_mut_checked(lights).unwrap_or_default();
    let size = usize::from(shape.view_axes).wrapping_mul(axes);
    let (core, usual) = scratch.split_at_mut_checked(size).unwrap_or_default();
    usual.fill(0.0);
    let (mut coder, mut numbers) = (Decoder::new(file.core), Numbers::default());
    for (column, step) in file.factors.core_steps.iter().enumerate() {
        core.fill(0.0);
        code_core(&mut coder, &mut numbers, axes, core, usual);
        for view in 0..views {
            // A_i[v] G[i] summed over i, for all j.
            let mut row = [0.0_f32; 255];
            let of_view = file.view_axes.iter().skip(view).step_by(views.max(1));
            let all = of_view.zip(file.factors.view_scales.iter()).zip(core.chunks_exact(axes.max(1)));
            for ((axis, scale), numbers) in all {
                let weight = f32::from(axis.cast_signed()) * scale;
                for (sum, number) in row.iter_mut().zip(numbers) {
                    *sum += weight * number;
                }
            }
            sums.fill(0.0);
            let of_lights = file.light_axes.chunks_exact(lights.max(1));
            for ((axis, scale), value) in of_lights.zip(file.factors.light_scales.iter()).zip(row) {
                let weight = scale * value * step;
                for (sum, at) in sums.iter_mut().zip(axis) {
                    *sum += weight * f32::from(at.cast_signed());
                }
            }
            let first = view.wrapping_mul(lights).wrapping_mul(columns).wrapping_add(column);
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
