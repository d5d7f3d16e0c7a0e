//! Ways to store q, for those that compare them.

use nalgebra::{DMatrix, DVector};

/// q of one channel of a mesh, stored in one way or another, for light that is a weighted sum of the stored lights.
pub trait Scheme: Sync {
    /// Exitance of all vertices under light of weights `[light]`, in the unit of what was stored. It may be a little below 0.
    fn exitance(&self, weights: &[f32]) -> Vec<f32>;
}

/// q itself, `[light × vertex]`.
impl Scheme for DMatrix<f32> {
    fn exitance(&self, weights: &[f32]) -> Vec<f32> {
        self.tr_mul(&DVector::from_column_slice(weights)).as_slice().to_vec()
    }
}
