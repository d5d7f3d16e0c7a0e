//! Eigenvectors of symmetric matrices, the largest eigenvalue first.

use nalgebra::DMatrix;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use crate::math::matrix::{orthonormal, product, transposed_product};

/// Dimensions beyond those asked for, which bring the space of the leading ones closer.
const OVERSAMPLING: usize = 16;
/// Rounds of subspace iteration.
const ROUNDS: usize = 4;

/// Eigenvalues and eigenvectors of a symmetric matrix.
pub(crate) struct Eigen {
    /// Eigenvalues, the largest first.
    pub(crate) values: Vec<f32>,
    /// Eigenvectors of unit length in the columns, in the order of [`Self::values`].
    pub(crate) vectors: DMatrix<f32>,
}

impl Eigen {
    /// Decomposition of a symmetric matrix; equal eigenvalues keep the order in which they are found.
    pub(crate) fn of(symmetric: DMatrix<f32>) -> Self {
        // In single precision, squares of small eigenvalues beside large ones may be lost, and all becomes NaN.
        let largest = symmetric.amax();
        let eigen = symmetric.clone().symmetric_eigen();
        let is_finite = |values: &[f32]| values.iter().all(|value| value.is_finite());
        if is_finite(eigen.eigenvalues.as_slice()) && is_finite(eigen.eigenvectors.as_slice()) || !largest.is_normal() {
            return Self::sorted(eigen.eigenvalues.as_slice(), &eigen.eigenvectors);
        }
        let eigen = symmetric.map(|value| f64::from(value) / f64::from(largest)).symmetric_eigen();
        let values: Vec<f32> = eigen.eigenvalues.cast::<f32>().iter().map(|value| value * largest).collect();
        Self::sorted(&values, &eigen.eigenvectors.cast::<f32>())
    }

    fn sorted(values: &[f32], vectors: &DMatrix<f32>) -> Self {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
        Self { values: order.iter().map(|k| values[*k]).collect(), vectors: vectors.select_columns(&order) }
    }

    /// The first `count` eigenvectors, or all if there are fewer.
    pub(crate) fn leading(&self, count: usize) -> DMatrix<f32> {
        self.vectors.columns(0, count.min(self.values.len())).into_owned()
    }
}

/// Orthonormal axes along which a positive semidefinite matrix is largest, the largest first, by subspace iteration (Halko,
/// Martinsson and Tropp 2011, algorithms 4.4 and 5.3): a few products in place of all eigenvectors. Where eigenvalues near
/// `count` are close to each other, axes mix with those that are left out, which are nearly as large. Axes of a matrix that is zero are zero.
pub(crate) fn leading_axes(matrix: DMatrix<f32>, count: usize) -> DMatrix<f32> {
    let size = matrix.nrows();
    let width = count + OVERSAMPLING;
    if size < 4 * width {
        return Eigen::of(matrix).leading(count);
    }
    let mut rng = Pcg64::seed_from_u64(1);
    let mut range = DMatrix::from_fn(size, width, |_, _| StandardNormal.sample(&mut rng));
    for _ in 0..ROUNDS {
        range = orthonormal(product(&matrix, &range));
    }
    let within = transposed_product(&range, &product(&matrix, &range));
    range * Eigen::of(within).leading(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Axes of a matrix whose eigenvalues fall as those of images do: as much is along them as along the eigenvectors.
    #[test]
    fn leading_axes_take_as_much_as_eigenvectors() {
        const COUNT: usize = 40;
        let wave = |x: usize, k: usize| ((x * (k + 1)) as f32 * 0.013 + k as f32).cos() / (k + 1) as f32;
        let columns = DMatrix::from_fn(300, 300, wave);
        let gram = &columns * columns.transpose();
        let [fast, exact] = [leading_axes(gram.clone(), COUNT), Eigen::of(gram.clone()).leading(COUNT)];
        let along = |axes: &DMatrix<f32>| (axes.transpose() * &gram * axes).trace();
        let (fast_share, exact_share) = (along(&fast) / gram.trace(), along(&exact) / gram.trace());
        assert!((fast_share - exact_share).abs() < 1e-4, "{fast_share} and {exact_share}");
        assert!(exact_share < 0.999, "something is left out: {exact_share}");
        let unit = fast.tr_mul(&fast) - DMatrix::identity(COUNT, COUNT);
        assert!(unit.amax() < 1e-4, "orthonormal: {}", unit.amax());
    }
}
