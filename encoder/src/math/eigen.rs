//! Eigenvectors of symmetric matrices, the largest eigenvalue first.

use nalgebra::DMatrix;

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
