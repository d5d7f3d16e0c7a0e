//! Sections of nested codebooks, checked once.

use super::layout::{CodebookSizes, MAX_STAGES, StageSizes};
use super::packed::CodebookSections;
use super::piecewise_linear::Axis;
use super::stage::Stage;
use crate::btf::grid::Grid;
use crate::container::bits::{Items, field, index_bits, mask};
use crate::container::sections::Sections;
use crate::error::ReadError;
use crate::section::Section;
use core::f32::consts::FRAC_PI_2;

/// Checked codebooks of a file: luma by stages, and chroma.
#[derive(Clone, Copy, Debug)]
pub struct NestedCodebooks<'a> {
    sizes: CodebookSizes,
    stages: [Stage<'a>; MAX_STAGES],
    /// M: P2 and I2.
    merged: Items<'a>,
    p2_bits: u32,
    p2_mask: u32,
    i2_mask: u32,
    i2: Items<'a>,
    i1: Items<'a>,
    /// Two codes of chroma each.
    colours: &'a [[u8; 2]],
    tints: &'a [[u8; 2]],
    tint_mask: u32,
    /// α and sin β.
    axes: [Axis; 2],
}

impl<'a> NestedCodebooks<'a> {
    /// Reads all codebooks of a file with `texels` texels in all materials and levels.
    pub(super) fn parse(sections: &Sections<'a>, grid: &Grid, texels: u32) -> Result<Self, ReadError> {
        let sizes = CodebookSizes::parse(sections.any(Section::CodebookSizes)?)?;
        let of = CodebookSections { sections, sizes: &sizes, grid };
        let unused = Stage::read(of, 0, texels)?;
        let mut stages = [unused; MAX_STAGES];
        for (number, stage) in (0..).zip(&mut stages).take(sizes.count).skip(1) {
            *stage = Stage::read(of, number, texels)?;
        }
        let [StageSizes { codebooks: [.., p2], .. }, ..] = sizes.stages;
        let (p2_bits, i2_bits) = (index_bits(p2.entries), index_bits(sizes.chroma.i2));
        let pairs = |section| Ok(of.sized(section)?.bytes.as_chunks().0);
        Ok(Self {
            sizes,
            stages,
            merged: of.items(Section::Merged)?,
            p2_bits,
            p2_mask: mask(p2_bits),
            i2_mask: mask(i2_bits),
            i2: of.items(Section::ChromaSlices2)?,
            i1: of.items(Section::ChromaSlices1)?,
            colours: pairs(Section::Colours)?,
            tints: if sizes.chroma.tints == 0 { &[] } else { pairs(Section::Tints)? },
            tint_mask: mask(index_bits(sizes.chroma.tints)),
            axes: [Axis::new(grid.n_alpha, grid.alpha_max, FRAC_PI_2), Axis::new(grid.n_beta, grid.sin_beta_max, 1.0)],
        })
    }

    /// Sizes and scales of the codebooks.
    #[must_use]
    pub fn sizes(&self) -> &CodebookSizes {
        &self.sizes
    }

    /// The first stage and the later ones.
    #[inline]
    pub(super) fn stages(&self) -> (&Stage<'a>, &[Stage<'a>]) {
        let [first, others @ ..] = &self.stages;
        (first, others.get(..self.sizes.count.wrapping_sub(1)).unwrap_or(&[]))
    }

    #[inline]
    pub(super) fn is_relative(&self) -> bool {
        self.sizes.chroma.is_relative
    }

    /// Chroma of code 0.
    #[inline]
    pub(super) fn chroma_first(&self) -> [f32; 2] {
        self.sizes.chroma.first
    }

    /// Chroma of a step of a code.
    #[inline]
    pub(super) fn chroma_step(&self) -> [f32; 2] {
        self.sizes.chroma.step
    }

    /// P2 and I2 of a row of M.
    #[inline]
    pub(super) fn merged(&self, row: u32) -> (u32, u32) {
        let bits = self.merged.bits(row, 0);
        (field(bits, 0, self.p2_mask), field(bits, self.p2_bits, self.i2_mask))
    }

    /// I2, rows of n_α rows of I1.
    #[inline]
    pub(super) fn i2(&self) -> &Items<'a> {
        &self.i2
    }

    /// I1, rows of n_β entries of C.
    #[inline]
    pub(super) fn i1(&self) -> &Items<'a> {
        &self.i1
    }

    /// Axes that samplers draw from: α, from −π/2 to π/2, and sin β, from −1 to 1.
    #[inline]
    pub(super) fn axes(&self) -> &[Axis; 2] {
        &self.axes
    }

    /// Codes of a and b of an entry of C.
    #[inline]
    pub(super) fn colour(&self, at: u32) -> [u8; 2] {
        match self.colours.get(at as usize) {
            Some(codes) => *codes,
            None => [0; 2],
        }
    }

    /// Mask of the tint's number, which stands in the highest bits of the items of P6.
    #[inline]
    pub(super) fn tint_mask(&self) -> u32 {
        self.tint_mask
    }

    /// Tint of both channels in steps of chroma.
    #[inline]
    pub(super) fn tint(&self, number: u32) -> [f32; 2] {
        self.tints.get(number as usize).map_or([0.0; 2], |codes| codes.map(|code| f32::from(code) - 128.0))
    }
}
