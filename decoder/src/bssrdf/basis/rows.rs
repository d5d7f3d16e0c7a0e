//! Rows of a separable basis as they pass: its widths, weights by pairs, factors by nodes.

use super::layout::{BasisSize, HEADER_BYTES, MAX_PROJECTION, MAX_WEIGHT};
use super::reader::{check_magnitudes, check_widths};
use crate::error::ReadError;
use crate::push::piece::Piece;
use crate::push::rows::{Arrived, Taken};

/// Bytes of a colour.
const RGB_BYTES: u64 = 12;
/// Bytes of a width.
const F32: u64 = 4;

/// S, and the size of the basis once it is known.
#[derive(Clone, Copy, Debug)]
pub(in crate::bssrdf) struct BasisRows {
    samples: u16,
    size: BasisSize,
}

impl BasisRows {
    /// Rows of a basis whose size is not known yet.
    pub(in crate::bssrdf) fn new(samples: u16) -> Self {
        Self { samples, size: BasisSize { terms: 1, gaussians: 1 } }
    }

    /// First bytes of weights and of factors.
    fn starts(&self) -> [u64; 2] {
        let [gaussians, pairs] = [self.size.gaussians, self.size.pairs()].map(|count| count as u64);
        let weights = gaussians.saturating_mul(F32).saturating_add(HEADER_BYTES as u64);
        [weights, pairs.saturating_mul(gaussians).saturating_mul(RGB_BYTES).saturating_add(weights)]
    }

    /// Bytes of the row from byte `at` on.
    pub(in crate::bssrdf) fn row_bytes(&self, at: u64) -> u64 {
        let gaussians = self.size.gaussians as u64;
        let [weights, factors] = self.starts();
        match at {
            0 => HEADER_BYTES as u64,
            at if at < weights => gaussians.saturating_mul(F32),
            at if at < factors => gaussians.saturating_mul(RGB_BYTES),
            _ => RGB_BYTES,
        }
    }

    /// Checks a row.
    pub(in crate::bssrdf) fn take<'r>(&mut self, arrived: &Arrived<'r>) -> Result<Taken<'r>, ReadError> {
        let row = arrived.row();
        let [weights, factors] = self.starts();
        if arrived.at == 0 {
            self.size = BasisSize::parse(row)?;
            arrived.entry.sized(self.size.section_bytes(self.samples))?;
            return Ok(Taken::Piece(Piece::Basis(self.size)));
        } else if arrived.at < weights {
            check_widths(row)?;
        } else {
            check_magnitudes(row, if arrived.at < factors { MAX_WEIGHT } else { MAX_PROJECTION })?;
        }
        Ok(Taken::Row)
    }
}
