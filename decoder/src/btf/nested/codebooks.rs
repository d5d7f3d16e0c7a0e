//! The sections of nested codebooks, checked once.

use super::piecewise_linear::Ruler;
use super::stage::Stage;
use super::table::{SliceTable, Table};
use crate::btf::grid::Grid;
use crate::btf::layout::{Books, ChromaBooks, MAX_STAGES, StageBooks};
use crate::container::bits::{Items, PADDING_BYTES, field, index_bits, mask, packed_bytes};
use crate::container::sections::Sections;
use crate::error::{ReadError, Section};
use core::f32::consts::FRAC_PI_2;

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
    /// Of α, and of sin β.
    rulers: [Ruler; 2],
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
        let shape = Shape { rows: chroma.merged, nodes: 1, width };
        let merged = sections.items(Section::Merged, shape, p2)?;
        sections.indices(Section::Merged, 0, merged, shape, p2_bits, chroma.i2)?;
        let indices =
            |section, rows, nodes, len| sections.items(section, Shape { rows, nodes, width: index_bits(len) }, len);
        let i2 = indices(Section::ChromaSlices2, chroma.i2, grid.n_alpha, chroma.i1)?;
        let i1 = indices(Section::ChromaSlices1, chroma.i1, grid.n_beta, chroma.colours)?;
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
            rulers: [
                Ruler::new(grid.n_alpha, grid.alpha_max, FRAC_PI_2),
                Ruler::new(grid.n_beta, grid.sin_beta_max, 1.0),
            ],
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

    /// What samplers draw from: α, from −π/2 to π/2, and sin β, from −1 to 1.
    #[inline]
    pub(super) fn rulers(&self) -> &[Ruler; 2] {
        &self.rulers
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

/// Rows of items of one width.
#[derive(Clone, Copy)]
struct Shape {
    rows: u32,
    nodes: u8,
    width: u32,
}

impl Shape {
    fn items(self) -> u64 {
        u64::from(self.rows).saturating_mul(self.nodes.into())
    }
}

impl<'a> Sections<'a, '_> {
    /// A section of items alone, whose lowest bits are an index that is less than `len`.
    fn items(&self, section: Section, shape: Shape, len: u32) -> Result<Items<'a>, ReadError> {
        let need = packed_bytes(shape.items(), shape.width).unwrap_or(u64::MAX);
        let items = Items::new(self.sized(section, need)?, shape.width, shape.nodes);
        self.indices(section, 0, items, shape, 0, len)?;
        Ok(items)
    }

    /// Checks the index at a bit of all items that stand after `before` bytes of a section.
    fn indices(
        &self,
        section: Section,
        before: u64,
        items: Items<'_>,
        shape: Shape,
        at: u32,
        len: u32,
    ) -> Result<(), ReadError> {
        let bits = index_bits(len);
        if len == 1_u32.wrapping_shl(bits) {
            // All that fits is in range.
            return Ok(());
        }
        let first_bit = |item: u64| item.saturating_mul(shape.width.into());
        let index = |item: u64| {
            let offset = usize::try_from(first_bit(item)).unwrap_or(usize::MAX);
            field(items.bits(0, offset), at, mask(bits))
        };
        match (0..shape.items()).find(|item| index(*item) >= len) {
            None => Ok(()),
            Some(item) => {
                let offset = before.saturating_add(first_bit(item).saturating_add(at.into()) >> 3);
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
        let items = |book, shape, len| self.items(section(book), shape, len);
        let shape_6 = Shape { rows: p6.entries, nodes: 1, width: width_6 };
        let texels = items(6, shape_6, p4.entries)?;
        if is_first && chroma.tints > 0 {
            let at = bits_of_p4.saturating_add(p6.scales.bits.into());
            self.indices(section(6), 0, texels, shape_6, at, chroma.tints)?;
        }
        let below_p3 = if is_first { chroma.merged } else { p2.entries };
        let p4_items = items(4, Shape { rows: p4.entries, nodes: grid.n_phi, width: width_4 }, p3.entries)?;
        let p3_items = items(3, Shape { rows: p3.entries, nodes: grid.n_theta, width: width_3 }, below_p3)?;
        // Codes of scales, then indices.
        let shape_2 = Shape { rows: p2.entries, nodes: grid.n_alpha, width: width_2 };
        let p2_items = packed_bytes(shape_2.items(), width_2).unwrap_or(u64::MAX);
        let p2_bytes = self.sized(section(2), shape_2.items().saturating_add(p2_items))?;
        let codes = usize::try_from(shape_2.items()).unwrap_or(usize::MAX);
        let p2_items = Items::new(p2_bytes.get(codes..).unwrap_or(&[]), width_2, grid.n_alpha);
        self.indices(section(2), shape_2.items(), p2_items, shape_2, 0, of_books.slices)?;
        let row = u64::from(grid.n_beta).saturating_add(1);
        let p1_bytes = u64::from(of_books.slices).saturating_mul(row).saturating_add(PADDING_BYTES as u64);
        Ok(Stage {
            texels: Table::new(texels, bits_of_p4, p6.scales, is_signed),
            p4: Table::new(p4_items, bits_of_p3, p4.scales, is_signed),
            p3: Table::new(p3_items, bits_below_p3, p3.scales, is_signed),
            p2: SliceTable::new(p2_bytes, grid.n_alpha, p2_items, bits_of_p1, p2.scales, is_signed),
            p1: self.sized(section(1), p1_bytes)?,
            n_beta: grid.n_beta,
            is_signed,
        })
    }
}
