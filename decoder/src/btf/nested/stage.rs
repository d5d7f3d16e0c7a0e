//! One chain of codebooks: texel → P6 → P4 (φ_v) → P3 (θ_v) → P2 (α) → P1 (β).

use super::scale::{NEAR, Scale};
use super::table::{SliceTable, Table};
use crate::btf::layout::{HEIGHTS_PER_OCTAVE, STEPS_PER_OCTAVE};

/// A step of heights in 1/64 octaves.
const HEIGHT: u32 = (STEPS_PER_OCTAVE / HEIGHTS_PER_OCTAVE).unsigned_abs();

/// A chain of codebooks, whose indices were checked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stage<'a> {
    /// P6, an item for every texel.
    pub(super) texels: Table<'a>,
    /// P4, rows of n_φ items.
    pub(super) p4: Table<'a>,
    /// P3, rows of n_θ items.
    pub(super) p3: Table<'a>,
    /// P2, rows of n_α items.
    pub(super) p2: SliceTable<'a>,
    /// P1, rows of n_β values and a height; more bytes follow.
    pub(super) p1: &'a [u8],
    pub(super) n_beta: u8,
    /// Whether values of P1 and scales have signs.
    pub(super) is_signed: bool,
}

impl Stage<'_> {
    /// Codes of nodes `at` and `at` + 1 of a slice, and how much larger it is than P2 says.
    #[inline]
    pub(super) fn slice_pair(&self, slice: u32, at: u32) -> ([u8; 2], Scale) {
        let start = self.start(slice);
        let first = start.wrapping_add(at) as usize;
        let codes = match self.p1.get(first..first.wrapping_add(2)) {
            Some([low, high]) => [*low, *high],
            _ => [0; 2],
        };
        (codes, Scale { exponent: self.height(start).wrapping_mul(HEIGHT).cast_signed(), sign: 0 })
    }

    /// First byte of a slice; 2²⁴ of them have less than 2³² bytes.
    #[inline]
    pub(super) fn start(&self, slice: u32) -> u32 {
        slice.wrapping_mul(u32::from(self.n_beta).wrapping_add(1))
    }

    /// Height of the slice that begins at a byte, for [`near`].
    #[inline]
    pub(super) fn near_height(&self, start: u32) -> u32 {
        self.height(start).wrapping_mul(HEIGHT << NEAR)
    }

    #[inline]
    fn height(&self, start: u32) -> u32 {
        match self.p1.get(start.wrapping_add(self.n_beta.into()) as usize) {
            Some(code) => u32::from(*code),
            None => 0,
        }
    }

    /// Four bytes of P1. They are there, as indices were checked.
    #[inline]
    pub(super) fn four(&self, start: u32) -> Option<&[u8; 4]> {
        // One comparison: what has 32 bits cannot wrap.
        let start = start as usize;
        self.p1.get(start..start.wrapping_add(4))?.first_chunk::<4>()
    }
}
