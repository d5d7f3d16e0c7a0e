//! Products of large matrices.

use nalgebra::DMatrix;
use rayon::prelude::*;

/// Columns that one thread multiplies at a time.
const BLOCK: usize = 512;

/// Matrix product left · right on all cores; the result does not depend on their number.
pub(crate) fn product(left: &DMatrix<f32>, right: &DMatrix<f32>) -> DMatrix<f32> {
    let mut out = DMatrix::zeros(left.nrows(), right.ncols());
    out.as_mut_slice().par_chunks_mut(left.nrows().max(1) * BLOCK).enumerate().for_each(|(block, out)| {
        let columns = right.columns(block * BLOCK, out.len() / left.nrows());
        let part = left * columns;
        out.copy_from_slice(part.as_slice());
    });
    out
}
