//! The mean profile, and normal equations relative to it.

use super::Normal;
use super::regulariser::regularise;
use crate::math::lanes::{Lanes, ZERO};
use crate::math::parallel;

impl Normal {
    /// Solves for the mean profile p̄, and makes b and y relative to it.
    pub(super) fn centre(&mut self, b: &[[f64; 3]]) {
        let nodes = self.geometry.nodes;
        // One profile for all: 2 Σ A_i p̄ = Σ b_i.
        let mut system = self.mean_matrix();
        let pixels = self.geometry.pixels();
        let mut b_sum = vec![[0.0_f64; 3]; nodes];
        for pixel in b.chunks(nodes) {
            for (sum, b) in b_sum.iter_mut().zip(pixel) {
                for c in 0..3 {
                    sum[c] += b[c];
                }
            }
        }
        regularise(&mut system);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_precision_loss,
            reason = "p̄ may be any profile near the mean"
        )]
        let mut mean: Vec<Lanes> = b_sum
            .iter()
            .map(|b| {
                let [r, g, b] = b.map(|b| (0.5 * b / pixels as f64) as f32);
                [r, g, b, 0.0]
            })
            .collect();
        system.cholesky().solve(&mut mean);

        // b_i − 2 A_i p̄.
        let mut centred = vec![ZERO; b.len()];
        parallel::for_chunks(&mut centred, nodes, |pixel, out| {
            let [d0, d1, _] = &self.matrix(pixel).all.diagonals;
            let b = &b[pixel * nodes..][..nodes];
            for h in 0..nodes {
                for c in 0..3 {
                    let a = |diagonal: &[Lanes], h: usize| f64::from(diagonal[h][c]);
                    let p = |h: usize| f64::from(mean[h][c]);
                    let mut product = a(d0, h) * p(h);
                    if h > 0 {
                        product += a(d1, h - 1) * p(h - 1);
                    }
                    if h + 1 < nodes {
                        product += a(d1, h) * p(h + 1);
                    }
                    #[allow(clippy::cast_possible_truncation, reason = "small once the mean is gone")]
                    let value = (b[h][c] - 2.0 * product) as f32;
                    out[h][c] = value;
                }
            }
        });
        // Σ φ (y − 2 a·p̄)² = Σ φ y² − 2 p̄·Σ b_i + 2 p̄·(Σ A_i) p̄ .. with b_i' = b_i − 2 A_i p̄: Σ φ y² − p̄·Σ (b_i + b_i').
        for (pixel, b) in b.chunks(nodes).zip(centred.chunks(nodes)).map(|(b, c)| (c, b)) {
            for h in 0..nodes {
                for c in 0..3 {
                    self.y2 -= f64::from(mean[h][c]) * (b[h][c] + f64::from(pixel[h][c]));
                }
            }
        }
        self.b = centred;
        self.mean = mean;
    }
}
