//! Products of large matrices.

use crate::math::parallel;
use nalgebra::DMatrix;

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
