//! One chain of codebooks: texel → P6 → P4 (φ_v) → P3 (θ_v) → P2 (α) → P1 (β).

use super::layout::{CodebookSize, CodebookSizes, SLICE_STEPS_PER_OCTAVE, STEPS_PER_OCTAVE};
use super::packed::CodebookSections;
use super::scale::{NEAR, Scale};
use super::table::{SliceTable, Table};
use crate::error::ReadError;
use crate::section::Section;

/// Step of the exponents of slices in 1/64 octaves.
const SLICE_STEP: u32 = (STEPS_PER_OCTAVE / SLICE_STEPS_PER_OCTAVE).unsigned_abs();

/// Chain of codebooks, whose indices were checked.
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
    /// P1, rows of n_β values and an exponent; more bytes follow.
    pub(super) p1: &'a [u8],
    pub(super) n_beta: u8,
    /// Whether values of P1 and scales have signs.
    pub(super) is_signed: bool,
}

impl<'a> Stage<'a> {
    /// Reads the five codebooks of stage `number`; P6 has an entry for each of `texels`.
    pub(super) fn read(of: CodebookSections<'a, '_>, number: u8, texels: u32) -> Result<Self, ReadError> {
        let section = |book: u8| Section::Codebook { book, stage: number };
        let CodebookSizes { chroma, stages, .. } = of.sizes;
        let sizes = stages.get(usize::from(number)).copied().unwrap_or_default();
        let [p6, p4, p3, p2] = sizes.codebooks;
        check_texels(section(6), p6, texels)?;
        let (is_signed, grid) = (sizes.is_signed, of.grid);
        let [bits_of_p4, bits_of_p3, bits_below_p3, bits_of_p1] = sizes.index_bits(number == 0, chroma);
        let (texels, p4_items, p3_items) = (of.items(section(6))?, of.items(section(4))?, of.items(section(3))?);
        // Codes of scales, then indices.
        let (of_p2, p2_items) = (of.sized(section(2))?.bytes, of.items(section(2))?);
        Ok(Self {
            texels: Table::new(texels, bits_of_p4, p6.scales, is_signed),
            p4: Table::new(p4_items, bits_of_p3, p4.scales, is_signed),
            p3: Table::new(p3_items, bits_below_p3, p3.scales, is_signed),
            p2: SliceTable::new(of_p2, grid.n_alpha, p2_items, bits_of_p1, p2.scales, is_signed),
            p1: of.sized(section(1))?.bytes,
            n_beta: grid.n_beta,
            is_signed,
        })
    }

    /// Codes of nodes `at` and `at` + 1 of a slice, and the slice's own scale.
    #[inline]
    pub(super) fn slice_pair(&self, slice: u32, at: u32) -> ([u8; 2], Scale) {
        let start = self.start(slice);
        let first = start.wrapping_add(at) as usize;
        let codes = match self.p1.get(first..first.wrapping_add(2)) {
            Some([low, high]) => [*low, *high],
            _ => [0; 2],
        };
        (codes, Scale { exponent: self.exponent(start).wrapping_mul(SLICE_STEP).cast_signed(), sign: 0 })
    }

    /// First byte of a slice; 2²⁴ of them have less than 2³² bytes.
    #[inline]
    pub(super) fn start(&self, slice: u32) -> u32 {
        slice.wrapping_mul(u32::from(self.n_beta).wrapping_add(1))
    }

    /// Exponent of the slice that begins at a byte, for [`near`](super::scale::near).
    #[inline]
    pub(super) fn near_exponent(&self, start: u32) -> u32 {
        self.exponent(start).wrapping_mul(SLICE_STEP << NEAR)
    }

    #[inline]
    fn exponent(&self, start: u32) -> u32 {
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

/// Refuses a P6 that has not an entry for each of `texels`.
pub(super) fn check_texels(section: Section, p6: CodebookSize, texels: u32) -> Result<(), ReadError> {
    if p6.entries == texels {
        return Ok(());
    }
    Err(ReadError::WrongSize { section, need_bytes: texels.into(), have_bytes: p6.entries.into() })
}
