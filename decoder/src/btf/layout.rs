//! The headers of a BTF file: `BTFH`, `MATS` and `BOOK`.

use super::colour::Tone;
use super::grid::{Grid, MAX_NODES};
use crate::container::bits::{MAX_ITEM_BITS, index_bits};
use crate::container::bytes::{array_at, f32_at, u16_at, u32_at};
use crate::container::put;
use crate::error::{ReadError, Section};

/// Bytes of the `BTFH` section.
pub const HEADER_BYTES: usize = 32;
/// Bytes of a material in `MATS`.
pub const MATERIAL_BYTES: usize = 32;
/// Bytes of a material's name.
pub const NAME_BYTES: usize = 24;
/// Bytes of chroma in `BOOK`, and of each stage after it.
pub const BOOK_BYTES: usize = 40;
/// Most additive stages of nested codebooks.
pub const MAX_STAGES: usize = 4;
/// Scales are powers of two in steps of 1/64 and multiples of it.
pub const STEPS_PER_OCTAVE: i32 = 64;
/// Slices have heights in these steps: code h stands for 2^(h/32).
pub const HEIGHTS_PER_OCTAVE: i32 = 32;
/// Largest magnitude of the exponent of a scale, in octaves.
pub const MAX_OCTAVES: i32 = 24;
/// Most entries of a codebook.
pub const MAX_ENTRIES: u32 = 1 << 24;
/// Smallest and largest linear values.
const TONES: [f32; 2] = [1e-6, 1e6];

/// How apparent BRDFs are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// Nested codebooks (Havran et al. 2010).
    Nested,
    /// Factors of texels and of directions.
    Factored,
}

/// What a BTF file says of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Header {
    /// How apparent BRDFs are stored.
    pub model: Model,
    /// What the channels are.
    pub tone: Tone,
    /// Number of materials, 1 to 255.
    pub materials: u8,
    /// Nodes of directions.
    pub grid: Grid,
}

impl Header {
    /// The section as it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; HEADER_BYTES] {
        let mut out = [0; HEADER_BYTES];
        let (tone, first, second) = match self.tone {
            Tone::Display { white } => (1, white, 0.0),
            Tone::LogLuv { toe, peak } => (2, toe, peak),
        };
        let model = match self.model {
            Model::Nested => 1,
            Model::Factored => 2,
        };
        let grid = &self.grid;
        put(&mut out, 0, &[model, tone, self.materials, 0, grid.n_alpha, grid.n_beta, grid.n_theta, grid.n_phi]);
        let floats = [grid.alpha_max, grid.sin_beta_max, grid.theta_max, grid.cos_light_min, first, second];
        for (offset, value) in (8..).step_by(4).zip(floats) {
            put(&mut out, offset, &value.to_le_bytes());
        }
        out
    }

    /// Reads and checks the section, which begins at `start` of the file.
    pub(in crate::btf) fn parse(bytes: &[u8], start: u64) -> Result<Self, ReadError> {
        let section = Section::BtfHeader;
        let have_bytes = bytes.len() as u64;
        let wrong = ReadError::WrongSize { section, need_bytes: HEADER_BYTES as u64, have_bytes };
        if bytes.len() != HEADER_BYTES {
            return Err(wrong);
        }
        let [model, tone, materials, _] = array_at(bytes, 0).ok_or(wrong)?;
        let [n_alpha, n_beta, n_theta, n_phi] = array_at(bytes, 4).ok_or(wrong)?;
        let field = |at: u64, value: u8| ReadError::BadField {
            section,
            offset: start.saturating_add(at),
            value: u32::from(value),
        };
        let model = match model {
            1 => Model::Nested,
            2 => Model::Factored,
            _ => return Err(field(0, model)),
        };
        if materials == 0 {
            return Err(field(2, 0));
        }
        for (at, nodes, fewest) in [(4, n_alpha, 2), (5, n_beta, 2), (6, n_theta, 2), (7, n_phi, 1)] {
            if !(fewest..=MAX_NODES).contains(&nodes) {
                return Err(field(at, nodes));
            }
        }
        let float = |at: usize, min: f32, max: f32| {
            let value = f32_at(bytes, at).ok_or(wrong)?;
            let offset = start.saturating_add(at as u64);
            let bad = ReadError::BadNumber { section, offset, value, min, max };
            // NaN is in no range.
            if (min..=max).contains(&value) { Ok(value) } else { Err(bad) }
        };
        const LEAST_ANGLE: f32 = 1e-3;
        let quarter = core::f32::consts::FRAC_PI_2;
        let grid = Grid {
            n_alpha,
            n_beta,
            n_theta,
            n_phi,
            alpha_max: float(8, LEAST_ANGLE, quarter)?,
            sin_beta_max: float(12, LEAST_ANGLE, 1.0)?,
            theta_max: float(16, LEAST_ANGLE, quarter)?,
            cos_light_min: float(20, 0.0, 0.999)?,
        };
        let [min, max] = TONES;
        let tone = match tone {
            1 => Tone::Display { white: float(24, min, max)? },
            2 => {
                let toe = float(24, min, max)?;
                Tone::LogLuv { toe, peak: float(28, toe, max)? }
            }
            _ => return Err(field(1, tone)),
        };
        Ok(Self { model, tone, materials, grid })
    }
}

/// One material of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Material {
    /// Its name, UTF-8, filled up with zeros.
    pub name: [u8; NAME_BYTES],
    /// Texels in x, 1 to 65,535.
    pub width: u16,
    /// Texels in y, 1 to 65,535.
    pub height: u16,
    /// Mipmap levels, 1 to 16; each is half as large as the one before it, rounded down, and at least one texel.
    pub levels: u8,
}

impl Material {
    /// The material as it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; MATERIAL_BYTES] {
        let mut out = [0; MATERIAL_BYTES];
        put(&mut out, 0, &self.name);
        put(&mut out, 24, &self.width.to_le_bytes());
        put(&mut out, 26, &self.height.to_le_bytes());
        put(&mut out, 28, &[self.levels]);
        out
    }

    /// Reads and checks it; `start` is where it stands in the file.
    pub(in crate::btf) fn parse(bytes: &[u8; MATERIAL_BYTES], start: u64) -> Result<Self, ReadError> {
        let field = |at: u64, value: u32| ReadError::BadField {
            section: Section::Materials,
            offset: start.saturating_add(at),
            value,
        };
        let name = array_at(bytes, 0).unwrap_or([0; NAME_BYTES]);
        let [width, height] = [24, 26].map(|at| u16_at(bytes, at).unwrap_or(0));
        let [levels] = array_at(bytes, 28).unwrap_or([0]);
        for (at, value) in [(24, width), (26, height)] {
            if value == 0 {
                return Err(field(at, 0));
            }
        }
        if !(1..=16).contains(&levels) {
            return Err(field(28, levels.into()));
        }
        Ok(Self { name, width, height, levels })
    }

    /// Its name, as far as it is UTF-8.
    #[must_use]
    pub fn name(&self) -> &str {
        let name = self.name.split(|byte| *byte == 0).next().unwrap_or(&[]);
        match core::str::from_utf8(name) {
            Ok(name) => name,
            Err(error) => {
                name.get(..error.valid_up_to()).and_then(|name| core::str::from_utf8(name).ok()).unwrap_or("")
            }
        }
    }

    /// Texels of a mipmap level in x and y.
    #[must_use]
    pub fn size(&self, level: u8) -> [u32; 2] {
        [self.width, self.height].map(|side| u32::from(side).wrapping_shr(level.min(16).into()).max(1))
    }

    /// Texels of the first `levels` levels.
    #[must_use]
    pub fn texels(&self, levels: u8) -> u32 {
        let area = |level| {
            let [width, height] = self.size(level);
            width.saturating_mul(height)
        };
        (0..levels.min(self.levels)).fold(0, |sum: u32, level| sum.saturating_add(area(level)))
    }
}

/// Scales of a codebook: 2^((offset + (code << step)) / 64).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Scales {
    /// Bits of a code, 0 to 16; the highest is the sign where the stage is signed.
    pub bits: u8,
    /// Binary logarithm of the step, in 1/64 octaves, 0 to 6.
    pub step: u8,
    /// Of code 0, in 1/64 octaves.
    pub offset: i16,
}

/// A codebook and what is said of it in `BOOK`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Book {
    /// Number of entries.
    pub entries: u32,
    /// Of the scales of its items.
    pub scales: Scales,
}

impl Book {
    fn to_bytes(self) -> [u8; 8] {
        let mut out = [0; 8];
        put(&mut out, 0, &self.entries.to_le_bytes());
        put(&mut out, 4, &[self.scales.bits, self.scales.step]);
        put(&mut out, 6, &self.scales.offset.to_le_bytes());
        out
    }
}

/// One additive stage: luma is the sum over stages, chroma comes with the first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageBooks {
    /// P6, P4, P3 and P2, entries of which have items for texels, φ_v, θ_v and α.
    pub books: [Book; 4],
    /// Entries of P1.
    pub slices: u32,
    /// Whether values of P1 and scales have signs; not in the first stage.
    pub is_signed: bool,
}

impl StageBooks {
    /// Bits of an item of P6, P4, P3 and P2: an index, the code of a scale, and in P6 of the first stage a tint. The lowest
    /// eight bits of the codes of P2 stand by themselves.
    #[must_use]
    pub fn widths(&self, is_first: bool, chroma: &ChromaBooks) -> [u32; 4] {
        let [p6, p4, p3, p2] = self.books;
        let (indices, tint) = (self.index_bits(is_first, chroma), if is_first { index_bits(chroma.tints) } else { 0 });
        let with_scale = |index: u32, book: Book| index.saturating_add(book.scales.bits.into());
        let [of_p4, of_p3, of_p2, of_p1] = indices;
        let above_bytes = u32::from(p2.scales.bits).saturating_sub(8);
        [
            with_scale(of_p4, p6).saturating_add(tint),
            with_scale(of_p3, p4),
            with_scale(of_p2, p3),
            of_p1.saturating_add(above_bytes),
        ]
    }

    /// Bits of the indices in P6, P4, P3 and P2; those of P3 lead to M in the first stage and to P2 in others.
    #[must_use]
    pub fn index_bits(&self, is_first: bool, chroma: &ChromaBooks) -> [u32; 4] {
        let [_, p4, p3, p2] = self.books;
        let below_p3 = if is_first { chroma.merged } else { p2.entries };
        [p4.entries, p3.entries, below_p3, self.slices].map(index_bits)
    }
}

/// The codebooks of chroma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChromaBooks {
    /// Entries of M, which joins P2 and I2.
    pub merged: u32,
    /// Entries of I2, with an item for every α.
    pub i2: u32,
    /// Entries of I1, with an item for every β.
    pub i1: u32,
    /// Entries of C.
    pub colours: u32,
    /// Entries of the tints of texels, 0 for none.
    pub tints: u32,
    /// Chroma of code 0, and of one step of a code, in both channels.
    pub first: [f32; 2],
    /// See `first`.
    pub step: [f32; 2],
    /// Whether chroma is divided by luma.
    pub is_relative: bool,
}

/// All codebooks of a nested file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Books {
    /// Of chroma.
    pub chroma: ChromaBooks,
    /// Of luma, one to four used.
    pub stages: [StageBooks; MAX_STAGES],
    /// How many are used.
    pub count: usize,
}

impl ChromaBooks {
    /// As it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; BOOK_BYTES] {
        let mut out = [0; BOOK_BYTES];
        let entries = [self.merged, self.i2, self.i1, self.colours, self.tints];
        for (offset, entries) in (0..).step_by(4).zip(entries) {
            put(&mut out, offset, &entries.to_le_bytes());
        }
        let ([first_a, first_b], [step_a, step_b]) = (self.first, self.step);
        for (offset, value) in (20..).step_by(4).zip([first_a, first_b, step_a, step_b]) {
            put(&mut out, offset, &value.to_le_bytes());
        }
        put(&mut out, 36, &[u8::from(self.is_relative)]);
        out
    }
}

impl StageBooks {
    /// As it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; BOOK_BYTES] {
        let mut out = [0; BOOK_BYTES];
        for (offset, book) in (0..).step_by(8).zip(self.books) {
            put(&mut out, offset, &book.to_bytes());
        }
        put(&mut out, 32, &self.slices.to_le_bytes());
        put(&mut out, 36, &[u8::from(self.is_signed)]);
        out
    }
}

/// Reads fields of `BOOK` and says where one is wrong.
struct Fields<'a> {
    bytes: &'a [u8],
    start: u64,
}

impl Fields<'_> {
    fn wrong(&self, at: usize, value: u32) -> ReadError {
        ReadError::BadField { section: Section::Books, offset: self.start.saturating_add(at as u64), value }
    }

    fn entries(&self, at: usize, fewest: u32) -> Result<u32, ReadError> {
        let entries = u32_at(self.bytes, at).unwrap_or(0);
        if (fewest..=MAX_ENTRIES).contains(&entries) { Ok(entries) } else { Err(self.wrong(at, entries)) }
    }

    fn flag(&self, at: usize) -> Result<bool, ReadError> {
        match array_at(self.bytes, at) {
            Some([0]) => Ok(false),
            Some([1]) => Ok(true),
            other => Err(self.wrong(at, other.map_or(0, |[byte]| byte.into()))),
        }
    }

    fn float(&self, at: usize) -> Result<f32, ReadError> {
        let value = f32_at(self.bytes, at).unwrap_or(0.0);
        let (min, max) = (-16.0, 16.0);
        let offset = self.start.saturating_add(at as u64);
        let bad = ReadError::BadNumber { section: Section::Books, offset, value, min, max };
        if (min..=max).contains(&value) { Ok(value) } else { Err(bad) }
    }

    fn scales(&self, at: usize) -> Result<Scales, ReadError> {
        let [bits, step] = array_at(self.bytes, at).unwrap_or([0; 2]);
        let offset = i16::from_le_bytes(array_at(self.bytes, at.saturating_add(2)).unwrap_or([0; 2]));
        if bits > 16 || step > 6 {
            return Err(self.wrong(at, u32::from(bits)));
        }
        let last = 1_i32.wrapping_shl(bits.into()).wrapping_sub(1).wrapping_shl(step.into());
        let limit = MAX_OCTAVES.saturating_mul(STEPS_PER_OCTAVE);
        // Sums of four exponents stay finite.
        if i32::from(offset) < limit.saturating_neg() || i32::from(offset).saturating_add(last) > limit {
            return Err(self.wrong(at, u32::from(bits)));
        }
        Ok(Scales { bits, step, offset })
    }

    fn stage(&self, at: usize, is_first: bool) -> Result<StageBooks, ReadError> {
        let mut books = [Book::default(); 4];
        for (at, book) in (at..).step_by(8).zip(&mut books) {
            let entries = self.entries(at, 1)?;
            *book = Book { entries, scales: self.scales(at.saturating_add(4))? };
        }
        let slices = self.entries(at.saturating_add(32), 1)?;
        let at = at.saturating_add(36);
        let is_signed = self.flag(at)?;
        if is_first && is_signed {
            return Err(self.wrong(at, 1));
        }
        Ok(StageBooks { books, slices, is_signed })
    }
}

impl Books {
    /// Reads and checks the section, which begins at `start` of the file.
    pub(in crate::btf) fn parse(bytes: &[u8], start: u64) -> Result<Self, ReadError> {
        let section = Section::Books;
        let stages = bytes.len().checked_div(BOOK_BYTES).unwrap_or(0).saturating_sub(1);
        let need = stages.clamp(1, MAX_STAGES).saturating_add(1).saturating_mul(BOOK_BYTES);
        if bytes.len() != need {
            return Err(ReadError::WrongSize { section, need_bytes: need as u64, have_bytes: bytes.len() as u64 });
        }
        let fields = Fields { bytes, start };
        let chroma = ChromaBooks {
            merged: fields.entries(0, 1)?,
            i2: fields.entries(4, 1)?,
            i1: fields.entries(8, 1)?,
            colours: fields.entries(12, 1)?,
            tints: fields.entries(16, 0)?,
            first: [fields.float(20)?, fields.float(24)?],
            step: [fields.float(28)?, fields.float(32)?],
            is_relative: fields.flag(36)?,
        };
        let mut books = Self { chroma, stages: [StageBooks::default(); MAX_STAGES], count: stages };
        for (number, stage) in books.stages.iter_mut().enumerate().take(stages) {
            *stage = fields.stage(number.saturating_add(1).saturating_mul(BOOK_BYTES), number == 0)?;
            let widest = stage.widths(number == 0, &books.chroma).into_iter().max().unwrap_or(0);
            if widest > MAX_ITEM_BITS {
                return Err(fields.wrong(number.saturating_add(1).saturating_mul(BOOK_BYTES), widest));
            }
        }
        Ok(books)
    }
}
