//! Low rank: truncated singular value decomposition of the profile in the plane.

use nalgebra::DMatrix;

use crate::kernel::grid::{Grid, Separable};

/// A_s of `terms` terms: the closest in the Frobenius norm (eq. S.2 to S.4), without rescaling.
///
/// `plane` is R_d in the cells of the quarter. With cells of widths h, the norm ∫∫ (R_d − A)² is that of the matrix
/// R_ij √(h_i h_j). R_d is even, and so are all singular vectors: half an axis has them all. The matrix is symmetric: its
/// singular values are |λ|, and the sign of λ is that of the term.
pub(in crate::kernel) fn svd(plane: &[f64], grid: &Grid, terms: usize) -> Separable {
    let n = grid.cells();
    let roots: Vec<f64> = grid.widths().into_iter().map(f64::sqrt).collect();
    let matrix = DMatrix::from_fn(n, n, |i, j| plane[i * n + j] * roots[i] * roots[j]);
    let eigen = matrix.symmetric_eigen();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].abs().total_cmp(&eigen.eigenvalues[*a].abs()));
    let term = |k: &usize| {
        let (value, vector) = (eigen.eigenvalues[*k], eigen.eigenvectors.column(*k));
        // Vectors are known up to their sign: the sum of a is positive.
        let sum: f64 = vector.iter().zip(&roots).map(|(v, root)| v * root).sum();
        let factor = value.abs().sqrt() * sum.signum();
        (value.signum(), vector.iter().zip(&roots).map(|(v, root)| factor * v / root).collect())
    };
    Separable { grid: grid.clone(), terms: order.iter().take(terms).map(term).collect() }
}

#[cfg(test)]
mod tests {
    use crate::kernel::method::gaussians;
    use crate::kernel::profile::shipped;
    use crate::metrics::kernel::Truth;

    /// Eckart and Young: before energies are rescaled, no sum of as many products is closer.
    #[test]
    fn nothing_of_that_rank_is_closer() {
        for name in shipped::names() {
            let radial = &shipped::profile(name).unwrap().channels[1];
            let radial = radial.cut(radial.radius_of(1e-3));
            let truth = Truth::new(&radial, 64);
            for terms in 1..=6 {
                let svd = truth.errors(&super::svd(&truth.plane, &truth.grid, terms)).frobenius;
                let gaussians = truth.errors(&gaussians(&radial, &truth.grid, terms)).frobenius;
                assert!(svd < gaussians, "{name}, {terms} terms: {svd}, Gaussians {gaussians}");
            }
        }
    }
}
