//! Truncated singular value decomposition of a matrix that is too large to hold.

use nalgebra::DMatrix;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use crate::math::eigen::Eigen;
use crate::math::matrix::orthonormal;
use crate::math::parallel;
use crate::progress::Progress;

/// Approximation of low rank A ≈ texelsᵀ · basisᵀ: U S in the rows of texels, V in the columns of the basis.
#[derive(Clone, Debug)]
pub struct LowRank {
    /// `[component × texel]`, the texels' coefficients U S; a texel's follow each other.
    pub texels: DMatrix<f32>,
    /// `[column of A × component]`, orthonormal columns V.
    pub basis: DMatrix<f32>,
}

impl LowRank {
    /// Components.
    pub(crate) fn rank(&self) -> usize {
        self.texels.nrows()
    }

    /// One component, of zeros.
    pub(crate) fn zero(texels: usize, columns: usize) -> Self {
        let basis = DMatrix::from_element(columns, 1, 1.0 / (columns as f32).sqrt());
        Self { texels: DMatrix::zeros(1, texels), basis }
    }
}

/// A matrix by its columns, each of `rows` values.
pub(crate) struct Columns<F> {
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    /// Columns that are filled together.
    pub(crate) group: usize,
    /// Writes the columns of a group, one after the other.
    pub(crate) fill: F,
}

/// Columns that are held at a time, a multiple of every group.
const BLOCK: usize = 96;
/// Rows that one thread multiplies.
const ROWS: usize = 2_048;
/// Dimensions beyond those asked for, which make the leading ones exact.
const OVERSAMPLING: usize = 16;
/// Rounds of subspace iteration.
const ROUNDS: usize = 1;

/// Passes over all columns that [`Columns::decompose`] makes.
pub(crate) const PASSES: u64 = 2 + 2 * ROUNDS as u64;

impl<F: Fn(usize, &mut [f32]) + Sync> Columns<F> {
    /// The leading `rank` components, by randomised subspace iteration (Halko, Martinsson and Tropp 2011, algorithms
    /// 4.4 and 5.1). Advances `progress` by [`PASSES`] · columns.
    pub(crate) fn decompose(&self, rank: usize, seed: u64, progress: &dyn Progress) -> LowRank {
        let width = (rank + OVERSAMPLING).min(self.rows).min(self.columns);
        let mut rng = Pcg64::seed_from_u64(seed);
        let mut test = DMatrix::from_fn(self.columns, width, |_, _| StandardNormal.sample(&mut rng));
        for _ in 0..ROUNDS {
            let range = orthonormal(self.times(&test, progress));
            test = orthonormal(self.transposed_times(&range, progress));
        }
        let range = orthonormal(self.times(&test, progress));
        // Qᵀ A = Bᵀ, B = V S Wᵀ by the eigenvectors of BᵀB; then A ≈ (Q W S) Vᵀ.
        let b = self.transposed_times(&range, progress);
        let eigen = Eigen::of(b.transpose() * &b);
        let largest = eigen.values.first().copied().unwrap_or(0.0);
        // What is left of nothing has no direction.
        let has_direction = |value: &&f32| **value > 1e-9 * largest && **value > 0.0;
        let singular: Vec<f32> =
            eigen.values.iter().take(rank).take_while(has_direction).map(|value| value.sqrt()).collect();
        let w = eigen.leading(singular.len());
        let mut basis = &b * &w;
        for (mut column, value) in basis.column_iter_mut().zip(&singular) {
            column /= *value;
        }
        let mut texels = (&range * &w).transpose();
        for (mut row, value) in texels.row_iter_mut().zip(&singular) {
            row *= *value;
        }
        LowRank { texels, basis }
    }

    /// Product A · right.
    fn times(&self, right: &DMatrix<f32>, progress: &dyn Progress) -> DMatrix<f32> {
        let mut parts: Vec<DMatrix<f32>> =
            (0..self.rows).step_by(ROWS).map(|row| DMatrix::zeros(ROWS.min(self.rows - row), right.ncols())).collect();
        self.blocks(progress, |first, block| {
            let right = right.rows(first, block.ncols());
            parallel::for_chunks(&mut parts, 1, |number, part| {
                let part = &mut part[0];
                part.gemm(1.0, &block.rows(number * ROWS, part.nrows()), &right, 1.0);
            });
        });
        let mut product = DMatrix::zeros(self.rows, right.ncols());
        for (number, part) in parts.iter().enumerate() {
            product.rows_mut(number * ROWS, part.nrows()).copy_from(part);
        }
        product
    }

    /// Product Aᵀ · right.
    fn transposed_times(&self, right: &DMatrix<f32>, progress: &dyn Progress) -> DMatrix<f32> {
        const SHARE: usize = BLOCK / 4;
        let mut product = DMatrix::zeros(self.columns, right.ncols());
        self.blocks(progress, |first, block| {
            let starts: Vec<usize> = (0..block.ncols()).step_by(SHARE).collect();
            let part = |start: usize| block.columns(start, SHARE.min(block.ncols() - start)).transpose() * right;
            let parts = parallel::map(starts.len(), |k| part(starts[k]));
            for (start, part) in starts.iter().zip(parts) {
                product.rows_mut(first + start, part.nrows()).copy_from(&part);
            }
        });
        product
    }

    /// Shows all columns to `work`, a block at a time, with the number of the first.
    fn blocks(&self, progress: &dyn Progress, mut work: impl FnMut(usize, &DMatrix<f32>)) {
        for first in (0..self.columns).step_by(BLOCK) {
            let count = BLOCK.min(self.columns - first);
            let mut block = DMatrix::zeros(self.rows, count);
            parallel::for_chunks(block.as_mut_slice(), self.rows * self.group, |number, columns| {
                (self.fill)(first / self.group + number, columns);
            });
            work(first, &block);
            progress.advance(count as u64);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_of_low_rank_comes_back() {
        let (rows, columns, rank) = (300, 250, 5);
        let wave = |k: usize, c: usize| ((k * (c + 1)) as f32 * 0.037 + c as f32).sin();
        let a = DMatrix::from_fn(rows, columns, |x, d| {
            (0..rank).map(|c| wave(x, c) * wave(d, c + 3) * 0.5_f32.powf(c as f32)).sum::<f32>()
        });
        let fill = |column: usize, out: &mut [f32]| out.copy_from_slice(a.column(column).as_slice());
        let found = Columns { rows, columns, group: 1, fill }.decompose(8, 1, &());
        let back = found.texels.transpose() * found.basis.transpose();
        assert!((&back - &a).norm() < 1e-4 * a.norm(), "{} of {}", (&back - &a).norm(), a.norm());
        let gram = found.basis.transpose() * &found.basis;
        assert!((gram - DMatrix::identity(found.basis.ncols(), found.basis.ncols())).norm() < 1e-2, "orthonormal");
        let energies: Vec<f32> = found.texels.row_iter().map(|row| row.norm()).collect();
        assert!(energies.is_sorted_by(|a, b| a >= b), "{energies:?}");
    }

    /// Of fewer components than are asked for, none is lost and none is made up.
    #[test]
    fn matrices_without_variation_come_back() {
        let sizes = [(1, 1), (1, 81), (2, 81), (64, 81), (81, 64), (64, 961), (300, 2)];
        let values: [fn(usize, usize) -> f32; 5] = [
            |_, _| 1.0,
            |x, _| x as f32,
            |_, d| 1.0 + d as f32,
            |x, d| if x == d { 3.0 } else { 0.0 },
            |x, d| (x as f32).sin() * (d as f32) + (x as f32).cos() * (d as f32).sqrt(),
        ];
        for ((rows, columns), value) in sizes.into_iter().flat_map(|size| values.map(|value| (size, value))) {
            for scale in [1.0, 1e-6, 6e4] {
                let a = DMatrix::from_fn(rows, columns, |x, d| scale * value(x, d));
                let fill = |column: usize, out: &mut [f32]| out.copy_from_slice(a.column(column).as_slice());
                let found = Columns { rows, columns, group: 1, fill }.decompose(128, 1, &());
                let back = found.texels.transpose() * found.basis.transpose();
                let error = (&back - &a).norm();
                assert!(error <= 1e-3 * a.norm(), "{rows} × {columns}: {error} of {}, rank {}", a.norm(), found.rank());
            }
        }
    }
}
