//! k-means by Euclidean distance, of the columns of a matrix.

use nalgebra::{DMatrix, DVectorView};

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
            let best = |(products, column): (DVectorView<'_, f64>, DVectorView<'_, f64>)| {
                // The least ½ ‖x − c‖² less ½ ‖x‖².
                let word = argmax(products.as_slice(), &halves, |product, half| product - half);
                let distance = halves[word] - products[word];
                let squared = 2.0 * distance + column.norm_squared();
                #[allow(clippy::cast_possible_truncation, reason = "beyond f32 it is infinite, which is farthest")]
                (u8::try_from(word).expect("at most 256"), squared as f32)
            };
            products.column_iter().zip(block.column_iter()).map(best).collect::<Vec<_>>()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_is_chosen_among_large_ones_that_are_alike() {
        // Squares of 10⁹, of which single precision keeps no more than 64.
        let value = |row: usize, column: usize| 30_000.0 + ((row * 7 + column * 13 + row * column) % 11) as f32;
        let words = DMatrix::from_fn(3, 20, |row, word| value(row, word % 19));
        let columns = DMatrix::from_fn(3, BLOCK + 9, |row, column| value(row + 1, column) + 0.25);
        let nearest = |column: usize| {
            let distance = |word: usize| (0..3).map(|row| (columns[(row, column)] - words[(row, word)]).powi(2)).sum();
            (0..20)
                .map(|word| (word, distance(word)))
                .fold((0, f32::INFINITY), |best, next| if next.1 < best.1 { next } else { best })
        };
        for (column, (word, squared)) in Euclidean(&columns).assign(&words).into_iter().enumerate() {
            assert_eq!((usize::from(word), squared), nearest(column), "column {column}");
        }
    }
}
