//! Symmetric matrices of bandwidth two, one per lane: a tridiagonal normal matrix and the square of a second difference.

use super::lanes::{Lanes, ZERO};

/// Diagonals 0, 1 and 2 of a symmetric positive matrix; entry h of diagonal k couples nodes h and h + k.
#[derive(Clone, Debug)]
pub(crate) struct Banded {
    pub(crate) diagonals: [Vec<Lanes>; 3],
}

impl Banded {
    pub(crate) fn new(nodes: usize) -> Self {
        Self { diagonals: std::array::from_fn(|_| vec![ZERO; nodes]) }
    }

    pub(crate) fn nodes(&self) -> usize {
        self.diagonals[0].len()
    }

    /// Adds `weight` · a aᵀ with a the hat weights (1 − w, w) of nodes h and h + 1.
    pub(crate) fn add_hat(&mut self, h: usize, w: f32, weight: &Lanes) {
        for c in 0..4 {
            self.diagonals[0][h][c] += weight[c] * (1.0 - w) * (1.0 - w);
            self.diagonals[1][h][c] += weight[c] * (1.0 - w) * w;
            self.diagonals[0][h + 1][c] += weight[c] * w * w;
        }
    }

    /// Adds `factor` times another matrix.
    pub(crate) fn add_scaled(&mut self, factor: f32, other: &Self) {
        for (mine, theirs) in self.diagonals.iter_mut().zip(&other.diagonals) {
            for (mine, theirs) in mine.iter_mut().zip(theirs) {
                super::lanes::add_scaled(mine, factor, theirs);
            }
        }
    }

    /// Adds `lambda` times the C² regulariser Σ_h (P̂^h − 2 P̂^{h+1} + P̂^{h+2})² (Yatagawa et al. 2020, section 3.3).
    pub(crate) fn add_smoothness(&mut self, lambda: f32) {
        const STENCIL: [f32; 3] = [1.0, -2.0, 1.0];
        for h in 0..self.nodes().saturating_sub(2) {
            for i in 0..3 {
                for j in i..3 {
                    for c in 0..3 {
                        self.diagonals[j - i][h + i][c] += lambda * STENCIL[i] * STENCIL[j];
                    }
                }
            }
        }
    }

    /// Adds `ridge` to the diagonal.
    pub(crate) fn add_ridge(&mut self, ridge: f32) {
        for value in &mut self.diagonals[0] {
            for c in 0..4 {
                value[c] += ridge;
            }
        }
    }

    /// Adds matrix · v to `out`.
    pub(crate) fn multiply_add(&self, v: &[Lanes], out: &mut [Lanes]) {
        let nodes = self.nodes();
        for (k, diagonal) in self.diagonals.iter().enumerate() {
            for h in 0..nodes.saturating_sub(k) {
                for c in 0..4 {
                    out[h][c] += diagonal[h][c] * v[h + k][c];
                    if k > 0 {
                        out[h + k][c] += diagonal[h][c] * v[h][c];
                    }
                }
            }
        }
    }

    /// Factors L D Lᵀ, L of unit diagonal; they take the matrix's place. Rows of zeros, which no pair touches, have zero
    /// solutions.
    pub(crate) fn cholesky(mut self) -> Cholesky {
        let nodes = self.nodes();
        let [d0, d1, d2] = &mut self.diagonals;
        for h in 0..nodes {
            for c in 0..4 {
                let pivot = d0[h][c];
                let (l1, l2) = if pivot > 0.0 { (d1[h][c] / pivot, d2[h][c] / pivot) } else { (0.0, 0.0) };
                if h + 1 < nodes {
                    d0[h + 1][c] -= l1 * d1[h][c];
                    d1[h + 1][c] -= l1 * d2[h][c];
                }
                if h + 2 < nodes {
                    d0[h + 2][c] -= l2 * d2[h][c];
                }
                d1[h][c] = l1;
                d2[h][c] = l2;
            }
        }
        Cholesky(self)
    }
}

/// Cholesky factors of a [`Banded`] matrix, L D Lᵀ with L of unit diagonal.
#[derive(Clone, Debug)]
pub(crate) struct Cholesky(Banded);

impl Cholesky {
    /// Solution of L D Lᵀ x = v, in place of v.
    pub(crate) fn solve(&self, v: &mut [Lanes]) {
        let [d, l1, l2] = &self.0.diagonals;
        let nodes = v.len();
        for h in 0..nodes {
            for c in 0..4 {
                if h + 1 < nodes {
                    v[h + 1][c] -= l1[h][c] * v[h][c];
                }
                if h + 2 < nodes {
                    v[h + 2][c] -= l2[h][c] * v[h][c];
                }
            }
        }
        for h in (0..nodes).rev() {
            for c in 0..4 {
                let mut value = if d[h][c] > 0.0 { v[h][c] / d[h][c] } else { 0.0 };
                if h + 1 < nodes {
                    value -= l1[h][c] * v[h + 1][c];
                }
                if h + 2 < nodes {
                    value -= l2[h][c] * v[h + 2][c];
                }
                v[h][c] = value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_what_it_multiplies() {
        let nodes = 7;
        let mut matrix = Banded::new(nodes);
        for h in 0..nodes - 1 {
            matrix.add_hat(h, 0.3, &[1.0, 2.0, 0.5, 0.0]);
        }
        matrix.add_smoothness(0.1);
        matrix.add_ridge(0.01);
        let x: Vec<Lanes> = (0..nodes).map(|h| [h as f32, 1.0 - h as f32, 0.5, 0.0]).collect();
        let mut v = vec![ZERO; nodes];
        matrix.multiply_add(&x, &mut v);
        matrix.cholesky().solve(&mut v);
        for (v, x) in v.iter().zip(&x) {
            for c in 0..4 {
                assert!((v[c] - x[c]).abs() < 1e-3, "{v:?} is not {x:?}");
            }
        }
    }
}
