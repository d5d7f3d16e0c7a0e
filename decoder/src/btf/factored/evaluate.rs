//! Values of texels from an expanded factored BTF, linear between the nodes of all four axes.

use super::layout::{CodewordStage, MAX_COEFFICIENTS, MAX_COLUMNS};
use super::reader::FactoredBtf;
use crate::btf::catalog::{Catalog, Texel};
use crate::btf::coord::{GridCoord, LerpCoord};
use crate::container::index::row_major;

/// Factored BTF, ready to be evaluated.
#[derive(Clone, Copy, Debug)]
pub struct ExpandedBtf<'b> {
    file: FactoredBtf<'b>,
    /// `[φ_v][θ_v][α][β][column]`
    table: &'b [i8],
    /// `[stage][codeword][coefficient]`
    words: &'b [i16],
}

/// Columns that are summed side by side.
const LANES: usize = 8;

impl<'b> ExpandedBtf<'b> {
    pub(super) fn new(file: &FactoredBtf<'b>, table: &'b [i8], words: &'b [i16]) -> Self {
        Self { file: *file, table, words }
    }

    /// Header and materials.
    #[must_use]
    pub fn catalog(&self) -> &Catalog<'b> {
        self.file.catalog()
    }

    /// Tables of all columns, `[φ_v][θ_v][α][β][column]`, in steps.
    #[must_use]
    pub fn table(&self) -> &'b [i8] {
        self.table
    }

    /// Value of a texel at coordinates of the grid; see [`Evaluate::eval_at`](crate::btf::Evaluate::eval_at).
    #[must_use]
    pub fn eval_at(&self, texel: Texel, coord: &GridCoord) -> [f32; 3] {
        self.value(texel, &self.interpolated(coord), coord.fade)
    }

    /// Values of texels that follow each other at one coordinate of the grid, where tables are interpolated once.
    pub(in crate::btf) fn eval_texels(&self, Texel(first): Texel, coord: &GridCoord, values: &mut [[f32; 3]]) {
        let columns = self.interpolated(coord);
        let mut texel = first;
        for value in values {
            *value = self.value(Texel(texel), &columns, coord.fade);
            texel = texel.wrapping_add(1);
        }
    }

    fn value(&self, texel: Texel, columns: &[f32; MAX_COLUMNS], fade: f32) -> [f32; 3] {
        self.catalog().header().encoding.decode(self.mixed(texel, columns)).map(|value| value * fade)
    }

    /// Coefficients of a texel in steps, as many as [`TuckerShape::coefficients`](super::layout::TuckerShape::coefficients) says
    /// and zeros after them: ρ of both channels, those of chroma, those of luma.
    #[must_use]
    pub fn coefficients(&self, texel: Texel) -> [i32; MAX_COEFFICIENTS] {
        let Texel(texel) = texel;
        let stages = self.file.shape().stages();
        let first = row_major(texel as usize, stages.len(), 0);
        let indices = self.file.indices.get(first..).unwrap_or(&[]);
        let mut sums = [0_i32; MAX_COEFFICIENTS];
        let mut words = self.words;
        for (stage, index) in stages.iter().zip(indices) {
            let CodewordStage { first, count, .. } = *stage;
            let at = row_major((*index).into(), count.into(), 0);
            let word = words.get(at..).unwrap_or(&[]).iter().take(count.into());
            for (sum, number) in sums.get_mut(usize::from(first)..).unwrap_or_default().iter_mut().zip(word) {
                *sum = sum.wrapping_add((*number).into());
            }
            words = words.get(stage.numbers()..).unwrap_or(&[]);
        }
        sums
    }

    /// Luma and chroma of a texel without the fading of low lights.
    #[must_use]
    pub fn channels(&self, texel: Texel, coord: &GridCoord) -> [f32; 3] {
        self.mixed(texel, &self.interpolated(coord))
    }

    /// Y = Σ_c u_c b_c, C = ρ Y + Σ_c v_c q_c.
    fn mixed(&self, texel: Texel, columns: &[f32; MAX_COLUMNS]) -> [f32; 3] {
        let shape = self.file.shape();
        let (luma, chroma) = (usize::from(shape.luma), usize::from(shape.chroma));
        // What the tables' columns are multiplied by.
        let steps = self.coefficients(texel);
        let [ratio_a, ratio_b, others @ ..] = steps;
        let (of_chroma, of_luma) = others.split_at_checked(chroma).unwrap_or_default();
        let in_order = of_luma.iter().take(luma).chain(of_chroma).chain(of_chroma);
        let mut weights = [0.0_f32; MAX_COLUMNS];
        for ((weight, step), factor) in weights.iter_mut().zip(in_order).zip(self.file.header.column_scales.iter()) {
            #[allow(clippy::cast_precision_loss, reason = "below 2²⁰")]
            let value = *step as f32 * factor;
            *weight = value;
        }
        let mut products = weights;
        for (product, column) in products.iter_mut().zip(columns) {
            *product *= column;
        }
        let (of_luma, others) = products.split_at_checked(luma).unwrap_or_default();
        let (of_a, others) = others.split_at_checked(chroma).unwrap_or_default();
        let (of_b, _) = others.split_at_checked(chroma).unwrap_or_default();
        let [y, a, b] = [of_luma, of_a, of_b].map(sum);
        let [step_a, step_b] = [0, 1].map(|c| self.file.header.ratio_steps.get(c).unwrap_or(0.0));
        #[allow(clippy::cast_precision_loss, reason = "below 2²⁰")]
        let [ratio_a, ratio_b] = [ratio_a as f32 * step_a, ratio_b as f32 * step_b];
        [y, ratio_a * y + a, ratio_b * y + b]
    }

    /// All columns at coordinates, in steps.
    fn interpolated(&self, coord: &GridCoord) -> [f32; MAX_COLUMNS] {
        let (grid, columns) = (self.catalog().grid(), self.file.shape().columns());
        let mut sums = [0.0_f32; MAX_COLUMNS];
        let row = |view: u32, light: u32| {
            let node = row_major(view as usize, grid.light_nodes(), light as usize);
            let first = row_major(node, columns, 0);
            self.table.get(first..first.wrapping_add(columns)).unwrap_or(&[])
        };
        let pairs = |first: LerpCoord, second: LerpCoord, stride: u8| {
            let ([a0, a1], [b0, b1]) = (first.nodes, second.nodes);
            let ([x0, x1], [y0, y1]) = (first.weights(), second.weights());
            let at = |a: u32, b: u32| a.wrapping_mul(stride.into()).wrapping_add(b);
            [(at(a0, b0), x0 * y0), (at(a0, b1), x0 * y1), (at(a1, b0), x1 * y0), (at(a1, b1), x1 * y1)]
        };
        let lights = pairs(coord.alpha, coord.beta, grid.n_beta);
        for (view, view_weight) in pairs(coord.phi, coord.theta, grid.n_theta) {
            let rows = lights.map(|(light, weight)| (row(view, light), view_weight * weight));
            add_rows(&mut sums, rows);
        }
        sums
    }
}

/// Sums in lanes of their own: additions do not wait for each other.
fn sum(values: &[f32]) -> f32 {
    let (blocks, rest) = values.as_chunks::<LANES>();
    let mut lanes = [0.0_f32; LANES];
    for block in blocks {
        for (lane, value) in lanes.iter_mut().zip(block) {
            *lane += value;
        }
    }
    let [a, b, c, d, e, f, g, h] = lanes;
    rest.iter().fold(((a + b) + (c + d)) + ((e + f) + (g + h)), |sum, value| sum + value)
}

/// Adds four weighted rows.
fn add_rows(sums: &mut [f32; MAX_COLUMNS], rows: [(&[i8], f32); 4]) {
    let [(a, wa), (b, wb), (c, wc), (d, wd)] = rows;
    let (of_sums, _) = sums.as_chunks_mut::<LANES>();
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let ((c, c_rest), (d, d_rest)) = (c.as_chunks::<LANES>(), d.as_chunks::<LANES>());
    let whole = a.len();
    for ((((sums, a), b), c), d) in of_sums.iter_mut().zip(a).zip(b).zip(c).zip(d) {
        for ((((sum, a), b), c), d) in sums.iter_mut().zip(a).zip(b).zip(c).zip(d) {
            *sum += (wa * f32::from(*a) + wb * f32::from(*b)) + (wc * f32::from(*c) + wd * f32::from(*d));
        }
    }
    let rest = sums.get_mut(whole.wrapping_mul(LANES)..).unwrap_or_default();
    for ((((sum, a), b), c), d) in rest.iter_mut().zip(a_rest).zip(b_rest).zip(c_rest).zip(d_rest) {
        *sum += (wa * f32::from(*a) + wb * f32::from(*b)) + (wc * f32::from(*c) + wd * f32::from(*d));
    }
}
