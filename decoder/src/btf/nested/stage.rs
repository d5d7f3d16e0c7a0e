//! One chain of codebooks: texel → P6 → P4 (φ_v) → P3 (θ_v) → P2 (α) → P1 (β).

use super::layout::{ChromaSizes, SLICE_STEPS_PER_OCTAVE, STEPS_PER_OCTAVE, StageSizes};
use super::packed::{Shape, items};
use super::scale::{NEAR, Scale};
use super::table::{SliceTable, Table};
use crate::btf::grid::Grid;
use crate::container::bits::PADDING_BYTES;
use crate::container::sections::Sections;
use crate::error::ReadError;
use crate::section::Section;
use core::num::Saturating;

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
    pub(super) fn read(
        sections: &Sections<'a>,
        number: u8,
        sizes: &StageSizes,
        chroma: &ChromaSizes,
        grid: &Grid,
        texels: u32,
    ) -> Result<Self, ReadError> {
        let section = |book: u8| Section::Codebook { book, stage: number };
        let [p6, p4, p3, p2] = sizes.codebooks;
        if p6.entries != texels {
            let (need_bytes, have_bytes) = (texels.into(), p6.entries.into());
            return Err(ReadError::WrongSize { section: section(6), need_bytes, have_bytes });
        }
        let (is_first, is_signed) = (number == 0, sizes.is_signed);
        let [of_p4, of_p3, below_p3, of_p1] = sizes.targets(is_first, chroma);
        let [bits_of_p4, bits_of_p3, bits_below_p3, bits_of_p1] = sizes.index_bits(is_first, chroma);
        let [width_6, width_4, width_3, width_2] = sizes.widths(is_first, chroma);

        let tint_at = bits_of_p4.saturating_add(p6.scales.bits.into());
        // One of one where there are none, which has no bits.
        let tint = (tint_at, if is_first { chroma.tints.max(1) } else { 1 });
        let shape_6 = Shape { rows: p6.entries, nodes: 1, width: width_6 };
        let shape_4 = Shape { rows: p4.entries, nodes: grid.n_phi, width: width_4 };
        let shape_3 = Shape { rows: p3.entries, nodes: grid.n_theta, width: width_3 };
        let texels = items(sections, section(6), shape_6, &[(0, of_p4), tint])?;
        let p4_items = items(sections, section(4), shape_4, &[(0, of_p3)])?;
        let p3_items = items(sections, section(3), shape_3, &[(0, below_p3)])?;

        // Codes of scales, then indices.
        let shape_2 = Shape { rows: p2.entries, nodes: grid.n_alpha, width: width_2 };
        let codes = shape_2.items();
        let of_p2 = sections.sized(section(2), codes.saturating_add(shape_2.bytes()))?;
        let p2_items = shape_2.checked(of_p2.from(usize::try_from(codes).unwrap_or(usize::MAX)), &[(0, of_p1)])?;

        // n_β values and an exponent for each slice.
        let [slices, n_beta] = [u64::from(sizes.slices), grid.n_beta.into()].map(Saturating);
        let p1_bytes = slices * (n_beta + Saturating(1)) + Saturating(PADDING_BYTES as u64);
        Ok(Self {
            texels: Table::new(texels, bits_of_p4, p6.scales, is_signed),
            p4: Table::new(p4_items, bits_of_p3, p4.scales, is_signed),
            p3: Table::new(p3_items, bits_below_p3, p3.scales, is_signed),
            p2: SliceTable::new(of_p2.bytes, grid.n_alpha, p2_items, bits_of_p1, p2.scales, is_signed),
            p1: sections.sized(section(1), p1_bytes.0)?.bytes,
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
