//! `BOOK`: sizes and scales of the nested codebooks.

use crate::container::bits::{MAX_ITEM_BITS, index_bits};
use crate::container::origin::Origin;
use crate::container::record::{Field, record};
use crate::container::sections::SectionBytes;
use crate::error::ReadError;
use core::mem::offset_of;

/// Bytes of chroma in `BOOK`, and of each stage after it.
pub const BOOK_BYTES: usize = size_of::<ChromaRecord>();
/// Largest number of additive stages.
pub const MAX_STAGES: usize = 4;
/// Scales are powers of two in steps of 1/64 octave and multiples of it.
pub const STEPS_PER_OCTAVE: i32 = 64;
/// Slices have exponents in these steps: code e stands for 2^(e/32).
pub const SLICE_STEPS_PER_OCTAVE: i32 = 32;
/// Largest magnitude of the exponent of a scale, in octaves.
pub const MAX_OCTAVES: i32 = 24;
/// Largest number of entries of a codebook.
pub const MAX_ENTRIES: u32 = 1 << 24;
/// Largest number of bits of a code of a scale.
const MAX_SCALE_BITS: u8 = 16;
/// Largest binary logarithm of the step of a scale.
const MAX_SCALE_STEP: u8 = 6;
/// Range of chroma of code 0, and of a step.
const CHROMA: [f32; 2] = [-16.0, 16.0];

record! {
    /// What `BOOK` begins with: chroma (`FORMAT.md`, section 4.4).
    ChromaRecord {
        merged: u32,
        i2: u32,
        i1: u32,
        colours: u32,
        tints: u32,
        first_a: f32,
        first_b: f32,
        step_a: f32,
        step_b: f32,
        is_relative: u8,
        reserved: [u8; 3],
    }
}

record! {
    /// What `BOOK` says of P6, P4, P3 or P2 of a stage.
    CodebookRecord {
        entries: u32,
        bits: u8,
        step: u8,
        offset: i16,
    }
}

record! {
    /// What `BOOK` says of a stage.
    StageRecord {
        p6: CodebookRecord,
        p4: CodebookRecord,
        p3: CodebookRecord,
        p2: CodebookRecord,
        slices: u32,
        is_signed: u8,
        reserved: [u8; 3],
    }
}

/// Quantised scales of a codebook: a code stands for 2^((offset + (code << step)) / 64).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Scales {
    /// Bits of a code, 0 to 16; the highest is the sign where the stage is signed.
    pub bits: u8,
    /// Binary logarithm of the step, in 1/64 octaves, 0 to 6.
    pub step: u8,
    /// Exponent of code 0, in 1/64 octaves.
    pub offset: i16,
}

/// Size of a codebook, and the scales of its items.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CodebookSize {
    /// Number of entries, 1 to 2²⁴.
    pub entries: u32,
    /// Scales of the items.
    pub scales: Scales,
}

/// Codebooks of one additive stage: luma is the sum over stages, chroma comes with the first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageSizes {
    /// P6, P4, P3 and P2, entries of which have items for texels, φ_v, θ_v and α.
    pub codebooks: [CodebookSize; 4],
    /// Entries of P1.
    pub slices: u32,
    /// Whether values of P1 and scales have signs; not in the first stage.
    pub is_signed: bool,
}

/// Codebooks of chroma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChromaSizes {
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
    /// Chroma a and b of code 0, −16 to 16.
    pub first: [f32; 2],
    /// Chroma a and b of one step of a code, −16 to 16.
    pub step: [f32; 2],
    /// Whether chroma is divided by luma.
    pub is_relative: bool,
}

/// Sizes of all codebooks of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CodebookSizes {
    /// Codebooks of chroma.
    pub chroma: ChromaSizes,
    /// Codebooks of luma, the first `count` used.
    pub stages: [StageSizes; MAX_STAGES],
    /// Number of stages, 1 to 4.
    pub count: usize,
}

impl ChromaSizes {
    /// Record as it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; BOOK_BYTES] {
        let Self { merged, i2, i1, colours, tints, is_relative, .. } = *self;
        let ([first_a, first_b], [step_a, step_b]) = (self.first, self.step);
        let (is_relative, reserved) = (is_relative.into(), [0; 3]);
        ChromaRecord { merged, i2, i1, colours, tints, first_a, first_b, step_a, step_b, is_relative, reserved }
            .to_bytes()
    }

    /// Reads and checks the record that stands at `origin`.
    fn parse(bytes: &[u8; BOOK_BYTES], origin: Origin) -> Result<Self, ReadError> {
        use ChromaRecord as R;
        let record = R::from_bytes(bytes);
        let entries = |at, value| origin.integer(at, value, 1..=MAX_ENTRIES);
        let chroma = |at, value| origin.number(at, value, CHROMA);
        Ok(Self {
            merged: entries(offset_of!(R, merged), record.merged)?,
            i2: entries(offset_of!(R, i2), record.i2)?,
            i1: entries(offset_of!(R, i1), record.i1)?,
            colours: entries(offset_of!(R, colours), record.colours)?,
            tints: origin.integer(offset_of!(R, tints), record.tints, 0..=MAX_ENTRIES)?,
            first: [chroma(offset_of!(R, first_a), record.first_a)?, chroma(offset_of!(R, first_b), record.first_b)?],
            step: [chroma(offset_of!(R, step_a), record.step_a)?, chroma(offset_of!(R, step_b), record.step_b)?],
            is_relative: flag(origin, offset_of!(R, is_relative), record.is_relative)?,
        })
    }
}

/// 0 or 1.
fn flag(origin: Origin, at: usize, value: u8) -> Result<bool, ReadError> {
    origin.integer(at, value, 0..=1).map(|value| value == 1)
}

impl CodebookSize {
    fn record(self) -> CodebookRecord {
        let Self { entries, scales: Scales { bits, step, offset } } = self;
        CodebookRecord { entries, bits, step, offset }
    }

    fn parse(record: CodebookRecord, origin: Origin) -> Result<Self, ReadError> {
        use CodebookRecord as R;
        let R { entries, bits, step, offset } = record;
        let entries = origin.integer(offset_of!(R, entries), entries, 1..=MAX_ENTRIES)?;
        origin.integer(offset_of!(R, bits), bits, 0..=MAX_SCALE_BITS.into())?;
        origin.integer(offset_of!(R, step), step, 0..=MAX_SCALE_STEP.into())?;
        let scales = Scales { bits, step, offset };
        // Sums of four exponents stay finite.
        let limit = MAX_OCTAVES.saturating_mul(STEPS_PER_OCTAVE);
        if i32::from(offset) < limit.saturating_neg() || scales.largest() > limit {
            return Err(origin.bad_field(offset_of!(R, bits), bits));
        }
        Ok(Self { entries, scales })
    }
}

impl Scales {
    /// Exponent of the largest code in 1/64 octaves: offset + (2^bits − 1) 2^step.
    fn largest(self) -> i32 {
        let codes = 1_i32.wrapping_shl(self.bits.into());
        codes.wrapping_sub(1).wrapping_shl(self.step.into()).saturating_add(self.offset.into())
    }
}

impl StageSizes {
    /// Record as it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; BOOK_BYTES] {
        let Self { codebooks, slices, is_signed } = *self;
        let [p6, p4, p3, p2] = codebooks.map(CodebookSize::record);
        StageRecord { p6, p4, p3, p2, slices, is_signed: is_signed.into(), reserved: [0; 3] }.to_bytes()
    }

    /// Reads and checks the record that stands at `origin`.
    fn parse(bytes: &[u8; BOOK_BYTES], origin: Origin, is_first: bool) -> Result<Self, ReadError> {
        use StageRecord as R;
        let record = R::from_bytes(bytes);
        let codebook = |at, record| CodebookSize::parse(record, origin.at(at));
        let codebooks = [
            codebook(offset_of!(R, p6), record.p6)?,
            codebook(offset_of!(R, p4), record.p4)?,
            codebook(offset_of!(R, p3), record.p3)?,
            codebook(offset_of!(R, p2), record.p2)?,
        ];
        let slices = origin.integer(offset_of!(R, slices), record.slices, 1..=MAX_ENTRIES)?;
        let is_signed = flag(origin, offset_of!(R, is_signed), record.is_signed)?;
        if is_first && is_signed {
            return Err(origin.bad_field(offset_of!(R, is_signed), record.is_signed));
        }
        Ok(Self { codebooks, slices, is_signed })
    }

    /// Bits of an item of P6, P4, P3 and P2: an index, the code of a scale, and in P6 of the first stage a tint. The lowest
    /// eight bits of the codes of P2 stand by themselves.
    #[must_use]
    pub fn widths(&self, is_first: bool, chroma: &ChromaSizes) -> [u32; 4] {
        let [p6, p4, p3, p2] = self.codebooks;
        let (indices, tint) = (self.index_bits(is_first, chroma), if is_first { index_bits(chroma.tints) } else { 0 });
        let with_scale = |index: u32, codebook: CodebookSize| index.saturating_add(codebook.scales.bits.into());
        let [of_p4, of_p3, of_p2, of_p1] = indices;
        let above_bytes = u32::from(p2.scales.bits).saturating_sub(8);
        [
            with_scale(of_p4, p6).saturating_add(tint),
            with_scale(of_p3, p4),
            with_scale(of_p2, p3),
            of_p1.saturating_add(above_bytes),
        ]
    }

    /// Entries of the codebooks that P6, P4, P3 and P2 lead to; P3 leads to M in the first stage and to P2 in others.
    #[must_use]
    pub fn targets(&self, is_first: bool, chroma: &ChromaSizes) -> [u32; 4] {
        let [_, p4, p3, p2] = self.codebooks;
        let below_p3 = if is_first { chroma.merged } else { p2.entries };
        [p4.entries, p3.entries, below_p3, self.slices]
    }

    /// Bytes of P1: for every entry n_β values and an exponent.
    #[must_use]
    pub fn slices_bytes(&self, n_beta: u8) -> u64 {
        u64::from(self.slices).saturating_mul(u64::from(n_beta).saturating_add(1))
    }

    /// Bits of the indices in P6, P4, P3 and P2.
    #[must_use]
    pub fn index_bits(&self, is_first: bool, chroma: &ChromaSizes) -> [u32; 4] {
        self.targets(is_first, chroma).map(index_bits)
    }
}

impl CodebookSizes {
    /// Reads and checks the section.
    pub(super) fn parse(section: SectionBytes<'_>) -> Result<Self, ReadError> {
        let (records, _) = section.bytes.as_chunks::<BOOK_BYTES>();
        let need_bytes = need_bytes(section.bytes.len() as u64);
        let count = records.len().saturating_sub(1).clamp(1, MAX_STAGES);
        let origin = section.sized(need_bytes)?.origin;
        let Some((chroma, records)) = records.split_first() else { return Err(section.wrong_size(need_bytes)) };

        let chroma = ChromaSizes::parse(chroma, origin)?;
        let mut stages = [StageSizes::default(); MAX_STAGES];
        for (number, (stage, record)) in stages.iter_mut().zip(records).enumerate() {
            let (origin, is_first) = (origin.at(BOOK_BYTES).at_item(number, BOOK_BYTES), number == 0);
            *stage = StageSizes::parse(record, origin, is_first)?;
            let [.., p2] = stage.codebooks;
            // M joins rows of P2 of the first stage and of I2.
            let merged = if is_first { index_bits(p2.entries).saturating_add(index_bits(chroma.i2)) } else { 0 };
            let widest = stage.widths(is_first, &chroma).into_iter().fold(merged, u32::max);
            if widest > MAX_ITEM_BITS {
                return Err(origin.bad_field(0, widest));
            }
        }
        Ok(Self { chroma, stages, count })
    }
}

/// Bytes that `BOOK` must have if it has `bytes`: those of as many whole stages as there can be.
pub(super) fn need_bytes(bytes: u64) -> u64 {
    const RECORD: u64 = BOOK_BYTES as u64;
    let stages = (bytes / RECORD).saturating_sub(1).clamp(1, MAX_STAGES as u64);
    stages.saturating_add(1).saturating_mul(RECORD)
}
