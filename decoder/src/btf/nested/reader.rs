//! The sections of nested codebooks, checked once.

use super::stage::{Stage, Table};
use crate::bits::{Items, PADDING_BYTES, field, index_bits, mask, packed_bytes};
use crate::btf::grid::Grid;
use crate::btf::layout::{Books, ChromaBooks, MAX_STAGES, StageBooks};
use crate::btf::sections::Sections;
use crate::error::{ReadError, Section};

/// Checked codebooks.
#[derive(Clone, Copy, Debug)]
pub struct Nested<'a> {
    books: Books,
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
}

impl<'a> Nested<'a> {
    /// Reads all codebooks of a file with `texels` texels in all materials and levels.
    pub(crate) fn parse(sections: &Sections<'a, '_>, grid: &Grid, texels: u32) -> Result<Self, ReadError> {
        let (start, bytes) = sections.any(Section::Books)?;
        let books = Books::parse(bytes, start)?;
        let chroma = &books.chroma;
        let empty = sections.stage(0, &books.stages[0], chroma, grid, texels)?;
        let mut stages = [empty; MAX_STAGES];
        for (number, (stage, of_books)) in stages.iter_mut().zip(&books.stages).enumerate().take(books.count).skip(1) {
            *stage = sections.stage(number, of_books, chroma, grid, texels)?;
        }
        let p2 = books.stages[0].books[3].entries;
        let p2_bits = index_bits(p2);
        let width = p2_bits.saturating_add(index_bits(chroma.i2));
        let merged = sections.items(Section::Merged, (chroma.merged, 1), width, 0, p2)?;
        sections.indices(Section::Merged, merged, chroma.merged.into(), p2_bits, chroma.i2)?;
        let indices = |section, rows, len| sections.items(section, rows, index_bits(len), 0, len);
        let i2 = indices(Section::ChromaSlices2, (chroma.i2, grid.n_alpha), chroma.i1)?;
        let i1 = indices(Section::ChromaSlices1, (chroma.i1, grid.n_beta), chroma.colours)?;
        let colours = sections.sized(Section::Colours, u64::from(chroma.colours).saturating_mul(2))?;
        let tints = if chroma.tints == 0 {
            &[]
        } else {
            sections.sized(Section::Tints, u64::from(chroma.tints).saturating_mul(2))?
        };
        Ok(Self {
            books,
            stages,
            merged,
            p2_bits,
            p2_mask: mask(p2_bits),
            i2_mask: mask(index_bits(chroma.i2)),
            i2,
            i1,
            colours: colours.as_chunks().0,
            tints: tints.as_chunks().0,
            tint_mask: mask(index_bits(chroma.tints)),
        })
    }

    /// What the file says of its codebooks.
    #[must_use]
    pub fn books(&self) -> &Books {
        &self.books
    }

    /// The first stage and the later ones.
    #[inline]
    pub(super) fn stages(&self) -> (&Stage<'a>, &[Stage<'a>]) {
        let [first, others @ ..] = &self.stages;
        (first, others.get(..self.books.count.wrapping_sub(1)).unwrap_or(&[]))
    }

    #[inline]
    pub(super) fn is_relative(&self) -> bool {
        self.books.chroma.is_relative
    }

    /// Chroma of code 0.
    #[inline]
    pub(super) fn chroma_first(&self) -> [f32; 2] {
        self.books.chroma.first
    }

    /// Chroma of a step of a code.
    #[inline]
    pub(super) fn chroma_step(&self) -> [f32; 2] {
        self.books.chroma.step
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

    /// Two codes of C.
    #[inline]
    pub(super) fn colour(&self, at: u32) -> [u8; 2] {
        match self.colours.get(at as usize) {
            Some(codes) => *codes,
            None => [0; 2],
        }
    }

    /// Of the tints that stand in the highest bits of the items of P6.
    #[inline]
    pub(super) fn tint_mask(&self) -> u32 {
        self.tint_mask
    }

    /// A tint in steps.
    #[inline]
    pub(super) fn tint(&self, number: u32) -> [f32; 2] {
        self.tints.get(number as usize).map_or([0.0; 2], |codes| codes.map(|code| f32::from(code) - 128.0))
    }
}

impl<'a> Sections<'a, '_> {
    /// Rows of nodes, items of `width` bits, of which the index that begins at bit `at` is less than `len`.
    fn items(
        &self,
        section: Section,
        (rows, nodes): (u32, u8),
        width: u32,
        at: u32,
        len: u32,
    ) -> Result<Items<'a>, ReadError> {
        let count = u64::from(rows).saturating_mul(nodes.into());
        let need = packed_bytes(count, width).unwrap_or(u64::MAX);
        let items = Items::new(self.sized(section, need)?, width, nodes);
        self.indices(section, items, count, at, len)?;
        Ok(items)
    }

    /// Checks an index in all items.
    fn indices(&self, section: Section, items: Items<'_>, count: u64, at: u32, len: u32) -> Result<(), ReadError> {
        let bits = index_bits(len);
        if len == 1_u32.wrapping_shl(bits) {
            // All that fits is in range.
            return Ok(());
        }
        let before = |item: u64| item.saturating_mul(items.width().into());
        let index = |item: u64| {
            let offset = usize::try_from(before(item)).unwrap_or(usize::MAX);
            field(items.bits(0, offset), at, mask(bits))
        };
        match (0..count).find(|item| index(*item) >= len) {
            None => Ok(()),
            Some(item) => {
                let offset = before(item).saturating_add(at.into()) >> 3;
                let offset = self.start(section).saturating_add(offset);
                Err(ReadError::IndexOutOfRange { section, offset, index: index(item), len })
            }
        }
    }

    fn stage(
        &self,
        number: usize,
        of_books: &StageBooks,
        chroma: &ChromaBooks,
        grid: &Grid,
        texels: u32,
    ) -> Result<Stage<'a>, ReadError> {
        let is_first = number == 0;
        let stage = u8::try_from(number).unwrap_or(u8::MAX);
        let section = |book: u8| Section::Codebook { book, stage };
        let [p6, p4, p3, p2] = of_books.books;
        if p6.entries != texels {
            let have_bytes = p6.entries.into();
            return Err(ReadError::WrongSize { section: section(6), need_bytes: texels.into(), have_bytes });
        }
        let is_signed = of_books.is_signed;
        let [bits_of_p4, bits_of_p3, bits_below_p3, bits_of_p1] = of_books.index_bits(is_first, chroma);
        let [width_6, width_4, width_3, width_2] = of_books.widths(is_first, chroma);
        let items = |book, rows, width, len| self.items(section(book), rows, width, 0, len);
        let texels = items(6, (p6.entries, 1), width_6, p4.entries)?;
        if is_first && chroma.tints > 0 {
            let at = bits_of_p4.saturating_add(p6.scales.bits.into());
            self.indices(section(6), texels, p6.entries.into(), at, chroma.tints)?;
        }
        let below_p3 = if is_first { chroma.merged } else { p2.entries };
        let p4_items = items(4, (p4.entries, grid.n_phi), width_4, p3.entries)?;
        let p3_items = items(3, (p3.entries, grid.n_theta), width_3, below_p3)?;
        let p2_items = items(2, (p2.entries, grid.n_alpha), width_2, of_books.slices)?;
        let values = u64::from(of_books.slices).saturating_mul(grid.n_beta.into());
        let p1_bytes = values.saturating_add(of_books.slices.into()).saturating_add(PADDING_BYTES as u64);
        let p1 = self.sized(section(1), p1_bytes)?;
        Ok(Stage {
            texels: Table::new(texels, bits_of_p4, p6.scales, is_signed),
            p4: Table::new(p4_items, bits_of_p3, p4.scales, is_signed),
            p3: Table::new(p3_items, bits_below_p3, p3.scales, is_signed),
            p2: Table::new(p2_items, bits_of_p1, p2.scales, is_signed),
            p1,
            means: usize::try_from(values).ok().and_then(|values| p1.get(values..)).unwrap_or(&[]),
            n_beta: grid.n_beta,
            is_signed,
        })
    }
}
