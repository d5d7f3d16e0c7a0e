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
        let eigen = symmetric.symmetric_eigen();
        let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        Self {
            values: order.iter().map(|k| eigen.eigenvalues[*k]).collect(),
            vectors: eigen.eigenvectors.select_columns(&order),
        }
    }

    /// The first `count` eigenvectors, or all if there are fewer.
    pub(crate) fn leading(&self, count: usize) -> DMatrix<f32> {
        self.vectors.columns(0, count.min(self.values.len())).into_owned()
    }
}
