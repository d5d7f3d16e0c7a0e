//! The least-squares problem that all models share (Yatagawa et al. 2020, eq. 5), reduced to its normal equations.
//!
//! With y_e = 2 ln Rd of every measured entry e from pixel i to pixel j, and a(r) the hat weights of eq. 3, the cost is
//!
//! ½ Σ_e φ(r) (a·p_i + a·p_j − y_e)²,
//!
//! and its gradient with respect to the profile p_i is A_i p_i + Σ_j φ n_ij a aᵀ p_j − b_i, where n_ij counts the
//! measured directions between i and j (0 to 2), A_i = Σ_j φ n_ij a aᵀ and b_i = Σ_e φ y_e a. One pass over the
//! capture gives A and b; it is not needed again. Entries that were not measured are in neither sum: they weigh
//! nothing.
//!
//! All profiles are taken relative to one mean profile p̄, which every convex combination leaves alone: the numbers
//! that matter are small differences of large ones, and f32 has to hold them.

mod centre;
mod counts;
mod matrices;
mod read;
pub(crate) mod regulariser;
mod sums;

use crate::bssrdf::window::{Geometry, Ring, rings};
use crate::capture::Capture;
use crate::error::{Error, Result};
use crate::math::banded::Banded;
use crate::math::lanes::Lanes;
use crate::math::parallel;
use crate::progress::Progress;
pub(crate) use matrices::Matrix;
use read::Block;
pub(crate) use read::{BLOCK_ROWS, BLOCKS_AT_ONCE};

/// The normal equations of a capture.
pub(crate) struct Normal {
    pub(crate) geometry: Geometry,
    pub(crate) rings: Vec<Ring>,
    /// Distinct matrices, and which one a pixel has.
    pub(crate) matrices: Vec<Matrix>,
    pub(crate) matrix_of: Vec<u32>,
    /// Measured directions n of every pixel and offset in ring order, two bits per channel; `None` if all are 2.
    counts: Option<Vec<u8>>,
    /// Right-hand sides b relative to the mean profile, `[pixel][node]`.
    b: Vec<Lanes>,
    /// Mean profile p̄ `[node]`, natural log of mm⁻².
    pub(crate) mean: Vec<Lanes>,
    /// Σ_e φ y_e² relative to the mean profile.
    pub(crate) y2: f64,
    /// Mean of the light that a pixel sends out and that it gets from others, Σ_e Rd_e over all measured entries that
    /// begin or end at it, halved; in mm⁻².
    pub(crate) exchange: Vec<[f64; 3]>,
    /// Entries inside the material, and those of them that were measured; three channels make three entries.
    pub(crate) entries: [u64; 2],
}

impl Normal {
    /// Normal equations of a capture, which is read once.
    pub(crate) fn of(capture: &Capture, geometry: Geometry, progress: &dyn Progress) -> Result<Self> {
        let rings = rings(&geometry);
        let mut b = vec![[0.0; 3]; geometry.pixels() * geometry.nodes];
        let mut exchange = vec![[0.0; 3]; geometry.pixels()];
        let mut y2 = 0.0;
        let mut entries = [0; 2];
        let mut faint = 0;
        let mut measured: Vec<Option<Vec<u8>>> = Vec::new();

        progress.begin("reading the capture", geometry.pixels() as u64);
        let firsts: Vec<usize> = (0..geometry.size[1]).step_by(BLOCK_ROWS).collect();
        for firsts in firsts.chunks(BLOCKS_AT_ONCE) {
            let block = |k: usize| Block::read(capture, &geometry, &rings, firsts[k], progress);
            let blocks: Vec<Block> = parallel::map(firsts.len(), block);
            for block in blocks {
                block.add_to(&geometry, &mut b, &mut exchange);
                y2 += block.y2;
                entries[0] += block.entries[0];
                entries[1] += block.entries[1];
                faint += block.faint;
                measured.push(block.measured);
            }
        }
        if entries[1] == 0 {
            let mut found = "nothing measured: no entry inside the material is finite and positive".to_owned();
            if faint > 0 {
                found = format!("{found}; {faint} are below {:e}", f32::MIN_POSITIVE);
            }
            return Err(Error::input(capture.path(), found, "at least one such entry"));
        }
        if faint > 0 {
            progress.warn(&capture.faint_warning(faint));
        }
        let counts = counts::counts(&geometry, &rings, &measured);
        drop(measured);
        let (matrices, matrix_of) = matrices::matrices(&geometry, &rings, counts.as_deref());
        let mut normal = Self {
            geometry,
            rings,
            matrices,
            matrix_of,
            counts,
            b: Vec::new(),
            mean: Vec::new(),
            exchange,
            y2,
            entries,
        };
        normal.centre(&b);
        Ok(normal)
    }

    pub(crate) fn matrix(&self, pixel: usize) -> &Matrix {
        &self.matrices[self.matrix_of[pixel] as usize]
    }

    /// How many pixels have each of the matrices.
    pub(crate) fn matrix_users(&self) -> Vec<u32> {
        let mut users = vec![0; self.matrices.len()];
        for &matrix in &self.matrix_of {
            users[matrix as usize] += 1;
        }
        users
    }

    /// The mean of A_i over all pixels.
    pub(crate) fn mean_matrix(&self) -> Banded {
        let mut mean = Banded::new(self.geometry.nodes);
        for (matrix, users) in self.matrices.iter().zip(self.matrix_users()) {
            #[allow(clippy::cast_precision_loss, reason = "a weight")]
            mean.add_scaled(users as f32 / self.geometry.pixels() as f32, &matrix.all);
        }
        mean
    }

    /// Right-hand side b_i of a pixel, `[node]`, relative to the mean profile.
    pub(crate) fn b(&self, pixel: usize) -> &[Lanes] {
        &self.b[pixel * self.geometry.nodes..][..self.geometry.nodes]
    }
}
