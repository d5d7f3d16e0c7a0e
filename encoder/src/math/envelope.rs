//! Cholesky factors of symmetric matrices with few entries beside the diagonal, as grids of nodes have them: before the first entry of
//! a row there is none in its factor either (Jennings 1966, *A compact storage scheme for the solution of symmetric linear
//! simultaneous equations*).

use nalgebra::DMatrix;

/// Numbers that are added up side by side: one after the other, each would wait for the sum before.
const LANES: usize = 8;

/// Factor L of A = L Lᵀ, rows from their first entry to the diagonal.
pub(crate) struct EnvelopeCholesky {
    rows: Vec<Vec<f64>>,
}

impl EnvelopeCholesky {
    /// Factor of a symmetric matrix; `None` if it is not positive definite.
    pub(crate) fn new(matrix: &DMatrix<f64>) -> Option<Self> {
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(matrix.ncols());
        for (i, column) in matrix.column_iter().enumerate() {
            let first = column.iter().position(|value| *value != 0.0)?.min(i);
            let mut row = column.as_slice()[first..=i].to_vec();
            for j in first..=i {
                // l_ij = (a_ij − Σ_k l_ik l_jk) / l_jj, over the columns k < j that both rows have.
                let (before, rest) = row.split_at_mut(j - first);
                let other = if j == i { &*before } else { rows[j].split_last()?.1 };
                let sum = rest[0] - dot(tail(before, other.len()), tail(other, before.len()));
                rest[0] = if j < i {
                    sum / rows[j].last()?
                } else if sum > 0.0 {
                    sum.sqrt()
                } else {
                    return None;
                };
            }
            rows.push(row);
        }
        Some(Self { rows })
    }

    /// Solves A x = v in place of v.
    pub(crate) fn solve(&self, v: &mut [f64]) {
        for (i, row) in self.rows.iter().enumerate() {
            let Some((diagonal, row)) = row.split_last() else { return };
            v[i] = (v[i] - dot(row, &v[i - row.len()..i])) / diagonal;
        }
        for (i, row) in self.rows.iter().enumerate().rev() {
            let Some((diagonal, row)) = row.split_last() else { return };
            let value = v[i] / diagonal;
            v[i] = value;
            v[i - row.len()..i].iter_mut().zip(row).for_each(|(v, l)| *v -= l * value);
        }
    }
}

/// The last `count` values at most.
fn tail(of: &[f64], count: usize) -> &[f64] {
    &of[of.len().saturating_sub(count)..]
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    /// Nodes of a ring and of a grid of several rows, as normal equations of interpolation have them.
    #[test]
    fn solutions_are_those_of_the_whole_matrix() {
        let (across, down) = (7, 5);
        let count = across * down;
        let mut matrix = DMatrix::identity(count, count) * 0.1;
        for node in 0..count {
            for other in [(node + 1) % count, (node + across) % count, (node + across + 1) % count] {
                let weight = 0.3 + 0.1 * (node % 3) as f64;
                matrix[(node, node)] += weight;
                matrix[(other, other)] += weight;
                matrix[(node, other)] -= weight;
                matrix[(other, node)] -= weight;
            }
        }
        let factor = EnvelopeCholesky::new(&matrix).unwrap();
        assert!(factor.rows[across + 2].len() < across + 3, "what is zero before the first entry is left out");
        let right = DVector::from_fn(count, |node, _| (node as f64).sin());
        let mut found = right.clone();
        factor.solve(found.as_mut_slice());
        let expected = matrix.clone().cholesky().unwrap().solve(&right);
        assert!((found - &expected).amax() < 1e-12 * expected.amax(), "{expected}");
        matrix[(3, 3)] = -1.0;
        assert!(EnvelopeCholesky::new(&matrix).is_none(), "not positive");
    }
}
