//! Products of large matrices, and orthonormal bases.

use crate::math::parallel;
use nalgebra::{DMatrix, RealField};

/// Columns that one thread multiplies at a time.
const BLOCK: usize = 512;

/// Matrix product left · right on all cores; the result does not depend on their number.
pub(crate) fn product(left: &DMatrix<f32>, right: &DMatrix<f32>) -> DMatrix<f32> {
    let mut out = DMatrix::zeros(left.nrows(), right.ncols());
    parallel::for_chunks(out.as_mut_slice(), left.nrows().max(1) * BLOCK, |block, out| {
        let columns = right.columns(block * BLOCK, out.len() / left.nrows());
        let part = left * columns;
        out.copy_from_slice(part.as_slice());
    });
    out
}

/// Product leftᵀ · right, some rows at a time: none of both is there twice.
pub(crate) fn transposed_product<T: RealField + Copy>(left: &DMatrix<T>, right: &DMatrix<T>) -> DMatrix<T> {
    const ROWS: usize = 1_024;
    let mut out = DMatrix::zeros(left.ncols(), right.ncols());
    for first in (0..left.nrows()).step_by(ROWS) {
        let count = ROWS.min(left.nrows() - first);
        out.gemm(T::one(), &left.rows(first, count).transpose(), &right.rows(first, count), T::one());
    }
    out
}

/// Orthonormal columns that span the same space, by Cholesky QR, twice.
pub(crate) fn orthonormal(matrix: DMatrix<f32>) -> DMatrix<f32> {
    // Twice: what Cholesky's factor leaves over in single precision, its second use removes.
    cholesky_qr(&cholesky_qr(&matrix))
}

fn cholesky_qr(matrix: &DMatrix<f32>) -> DMatrix<f32> {
    // Double precision: the leading component is many times as long as the last.
    let double = matrix.map(f64::from);
    let gram = transposed_product(&double, &double);
    // Columns that depend on others get a little of their own, rather than none.
    let ridge = DMatrix::identity(gram.ncols(), gram.ncols()) * (gram.trace().max(1e-30) * 1e-13);
    let upper = (gram + ridge).cholesky().expect("it is positive: a ridge was added").l().transpose();
    let inverse = upper.try_inverse().expect("its diagonal is positive").cast::<f32>();
    matrix * inverse
}
