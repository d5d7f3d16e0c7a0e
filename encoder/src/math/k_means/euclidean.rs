//! k-means by Euclidean distance, of the columns of a matrix.

use nalgebra::DMatrix;

use super::KMeans;
use crate::math::argmax::argmax;
use crate::math::parallel;

/// Columns that one thread compares at a time.
const BLOCK: usize = 1_024;

/// Vectors in the columns of a matrix. Codewords, at most 256, may be shorter: only as many of the first coordinates count.
pub(crate) struct Euclidean<'a>(pub(crate) &'a DMatrix<f32>);

/// Number of a codeword, and the squared distance to it.
pub(crate) type Choice = (u8, f32);

impl KMeans for Euclidean<'_> {
    /// Codewords in the columns.
    type Codebook = DMatrix<f32>;
    type Assignment = Vec<Choice>;

    fn assign(&self, words: &DMatrix<f32>) -> Vec<Choice> {
        let columns = self.0;
        let count = words.nrows();
        // Double precision: distances are differences of numbers that are far larger.
        let words = words.map(f64::from);
        let halves: Vec<f64> = words.column_iter().map(|word| 0.5 * word.norm_squared()).collect();
        let transposed = words.transpose();
        let starts: Vec<usize> = (0..columns.ncols()).step_by(BLOCK).collect();
        let of_block = |start: usize| {
            let block = columns.view((0, start), (count, BLOCK.min(columns.ncols() - start))).map(f64::from);
            let products = &transposed * &block;
            let best = |(products, column): (&[f64], nalgebra::DVectorView<'_, f64>)| {
                // The least ½ ‖x − c‖² less ½ ‖x‖².
                let word = argmax(products, &halves, |product, half| product - half);
                let distance = halves[word] - products[word];
                let squared = 2.0 * distance + column.norm_squared();
                #[allow(clippy::cast_possible_truncation, reason = "infinite where f32 ends")]
                (u8::try_from(word).expect("at most 256"), squared as f32)
            };
            products.as_slice().chunks(halves.len()).zip(block.column_iter()).map(best).collect::<Vec<_>>()
        };
        parallel::map(starts.len(), |k| of_block(starts[k])).concat()
    }

    /// Means of the columns of every codeword; those that nothing chose start again at what is farthest from its own.
    fn update(&self, chosen: &Vec<Choice>, words: &mut DMatrix<f32>) {
        let columns = self.0;
        let count = words.nrows();
        let mut sums = DMatrix::<f32>::zeros(count, words.ncols());
        let mut members = vec![0_usize; words.ncols()];
        for (column, (word, _)) in chosen.iter().enumerate() {
            let word = usize::from(*word);
            members[word] += 1;
            let mut sum = sums.column_mut(word);
            sum += columns.column(column).rows(0, count);
        }
        let empty = members.iter().filter(|members| **members == 0).count();
        let mut far: Vec<usize> = (0..chosen.len()).collect();
        if empty > 0 && far.len() > empty {
            far.select_nth_unstable_by(empty, |a, b| chosen[*b].1.total_cmp(&chosen[*a].1).then(a.cmp(b)));
            far.truncate(empty);
            far.sort_unstable();
        }
        let mut far = far.into_iter();
        for (word, members) in members.iter().enumerate() {
            let mut of_word = words.column_mut(word);
            if *members > 0 {
                of_word.copy_from(&(sums.column(word) / *members as f32));
            } else if let Some(column) = far.next() {
                of_word.copy_from(&columns.column(column).rows(0, count));
            }
        }
    }
}
