//! `FACT`: sizes and steps of a Tucker decomposition.

use crate::btf::grid::Grid;
use crate::container::bytes::F32Le;
use crate::container::origin::Origin;
use crate::container::record::{Field, record};
use crate::container::sections::SectionBytes;
use crate::error::ReadError;
use core::mem::offset_of;

/// Largest number of stages of codewords.
pub const MAX_STAGES: usize = MOST_STAGES as usize;
/// [`MAX_STAGES`] as files count them.
const MOST_STAGES: u8 = 32;
/// Largest number of components of luma.
pub const MAX_LUMA: u8 = 128;
/// Largest number of components of chroma.
pub const MAX_CHROMA: u8 = 32;
/// Largest number of coefficients of a texel.
pub const MAX_COEFFICIENTS: usize = 2 + MAX_CHROMA as usize + MAX_LUMA as usize;
/// Largest number of columns of tables.
pub const MAX_COLUMNS: usize = 2 * MAX_CHROMA as usize + MAX_LUMA as usize;
/// Range of all steps and scales.
const STEPS: [f32; 2] = [0.0, 1e6];

record! {
    /// What `FACT` begins with (`FORMAT.md`, section 5.1).
    FixedRecord {
        luma: u8,
        chroma: u8,
        stages: u8,
        reserved: u8,
        view_axes: u8,
        light_axes: u8,
        reserved_too: [u8; 2],
    }
}

record! {
    /// What `FACT` says of a stage.
    StageRecord {
        codewords_less_one: u8,
        first: u8,
        count: u8,
        reserved: u8,
    }
}

/// One stage of a residual vector quantiser: how many codewords, and which coefficients they add to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CodewordStage {
    /// Number of codewords, 1 to 256.
    pub words: u16,
    /// First coefficient that they add to.
    pub first: u8,
    /// Number of coefficients that they add to, at least 1.
    pub count: u8,
}

impl CodewordStage {
    /// Number of coefficients in all of its codewords.
    #[must_use]
    pub fn numbers(&self) -> usize {
        usize::from(self.words).wrapping_mul(self.count.into())
    }
}

/// Sizes of a Tucker decomposition and of the codewords of texels.
///
/// A texel has the coefficients ρ_Cr, ρ_Cb, those of chroma, those of luma. Tables have columns of luma, of the first
/// channel of chroma, of the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TuckerShape {
    /// Components of luma, 1 to 128.
    pub luma: u8,
    /// Components of chroma, 0 to 32.
    pub chroma: u8,
    /// Axes of views, 1 to 255.
    pub view_axes: u8,
    /// Axes of lights, 1 to 255.
    pub light_axes: u8,
    /// Stages of codewords, the first `count` used.
    pub stages: [CodewordStage; MAX_STAGES],
    /// Number of stages, 1 to 32.
    pub count: u8,
}

impl TuckerShape {
    /// Number of coefficients of a texel, 2 + m + n.
    #[must_use]
    pub fn coefficients(&self) -> usize {
        usize::from(self.luma).wrapping_add(self.chroma.into()).wrapping_add(2)
    }

    /// Number of columns of tables, n + 2 m.
    #[must_use]
    pub fn columns(&self) -> usize {
        usize::from(self.luma).wrapping_add(usize::from(self.chroma) << 1)
    }

    /// Numbers in the core of one column, I · J.
    #[must_use]
    pub fn core_len(&self) -> usize {
        usize::from(self.view_axes).wrapping_mul(self.light_axes.into())
    }

    /// Stages that are used.
    #[must_use]
    pub fn stages(&self) -> &[CodewordStage] {
        self.stages.get(..usize::from(self.count)).unwrap_or(&[])
    }

    /// First bytes of the section, which the numbers follow.
    pub fn to_bytes(&self) -> impl Iterator<Item = u8> + '_ {
        let Self { luma, chroma, count: stages, view_axes, light_axes, .. } = *self;
        let (reserved, reserved_too) = (0, [0; 2]);
        let fixed = FixedRecord { luma, chroma, stages, reserved, view_axes, light_axes, reserved_too };
        fixed
            .to_bytes::<{ size_of::<FixedRecord>() }>()
            .into_iter()
            .chain(self.stages().iter().flat_map(|stage| stage.record().to_bytes::<{ size_of::<StageRecord>() }>()))
    }

    /// Reads and checks the first bytes of the section.
    fn parse(section: SectionBytes<'_>, grid: &Grid) -> Result<Self, ReadError> {
        use FixedRecord as R;
        let origin = section.origin;
        if section.bytes.len() < size_of::<R>() {
            return Err(section.wrong_size(size_of::<R>() as u64));
        }
        let R { luma, chroma, stages: count, view_axes, light_axes, .. } = R::from_bytes(section.bytes);
        let limit = |nodes: usize| u8::try_from(nodes).unwrap_or(u8::MAX).into();
        origin.integer(offset_of!(R, luma), luma, 1..=MAX_LUMA.into())?;
        origin.integer(offset_of!(R, chroma), chroma, 0..=MAX_CHROMA.into())?;
        origin.integer(offset_of!(R, stages), count, 1..=MOST_STAGES.into())?;
        origin.integer(offset_of!(R, view_axes), view_axes, 1..=limit(grid.view_nodes()))?;
        origin.integer(offset_of!(R, light_axes), light_axes, 1..=limit(grid.light_nodes()))?;

        let stages = [CodewordStage::default(); MAX_STAGES];
        let mut shape = Self { luma, chroma, view_axes, light_axes, stages, count };
        let coefficients = shape.coefficients();
        let mut rest = section.from(size_of::<R>());
        for (number, stage) in shape.stages.iter_mut().enumerate().take(count.into()) {
            let Some(bytes) = rest.bytes.first_chunk::<{ size_of::<StageRecord>() }>() else {
                return Err(section.wrong_size(stages_end(number.saturating_add(1)) as u64));
            };
            *stage = CodewordStage::parse(bytes, rest.origin, coefficients)?;
            rest = rest.from(size_of::<StageRecord>());
        }
        Ok(shape)
    }
}

/// Bytes of the section up to the end of its first `stages` stages.
fn stages_end(stages: usize) -> usize {
    stages.saturating_mul(size_of::<StageRecord>()).saturating_add(size_of::<FixedRecord>())
}

impl CodewordStage {
    fn record(self) -> StageRecord {
        let Self { words, first, count } = self;
        let codewords_less_one = u8::try_from(words.wrapping_sub(1)).unwrap_or(u8::MAX);
        StageRecord { codewords_less_one, first, count, reserved: 0 }
    }

    /// Reads and checks the record that stands at `origin`.
    fn parse(bytes: &[u8; size_of::<StageRecord>()], origin: Origin, coefficients: usize) -> Result<Self, ReadError> {
        let StageRecord { codewords_less_one, first, count, .. } = StageRecord::from_bytes(bytes);
        if count == 0 || usize::from(first).wrapping_add(count.into()) > coefficients {
            return Err(origin.bad_field(offset_of!(StageRecord, count), count));
        }
        Ok(Self { words: u16::from(codewords_less_one).wrapping_add(1), first, count })
    }
}

/// Header of a factored BTF: sizes, and what the integers of the other sections stand for.
#[derive(Clone, Copy, Debug)]
pub struct TuckerHeader<'a> {
    /// Sizes of everything.
    pub shape: TuckerShape,
    /// ρ of one step, for both channels.
    pub ratio_steps: F32Le<'a>,
    /// Value of one step of a coefficient times one step of a table, by columns.
    pub column_scales: F32Le<'a>,
    /// Steps of a table that one step of the core is, by columns.
    pub core_steps: F32Le<'a>,
    /// Value of one step of each axis of views.
    pub view_scales: F32Le<'a>,
    /// Value of one step of each axis of lights.
    pub light_scales: F32Le<'a>,
}

impl<'a> TuckerHeader<'a> {
    /// Reads and checks the section.
    pub(super) fn parse(section: SectionBytes<'a>, grid: &Grid) -> Result<Self, ReadError> {
        const F32_BYTES: usize = size_of::<f32>();
        let shape = TuckerShape::parse(section, grid)?;
        let columns = shape.columns();
        let lengths = [2, columns, columns, shape.view_axes.into(), shape.light_axes.into()];
        let start = stages_end(shape.count.into());
        let need = lengths.iter().fold(start, |end, length| end.saturating_add(length.saturating_mul(F32_BYTES)));
        let mut rest = section.sized(need as u64)?.from(start);
        let mut next = |length: usize| {
            let bytes = length.saturating_mul(F32_BYTES);
            let steps = F32Le::new(rest.bytes.get(..bytes).unwrap_or(&[]));
            for (number, value) in steps.iter().enumerate() {
                rest.origin.number(number.saturating_mul(F32_BYTES), value, STEPS)?;
            }
            rest = rest.from(bytes);
            Ok(steps)
        };
        let [of_ratios, of_columns, of_core, of_views, of_lights] = lengths;
        Ok(Self {
            shape,
            ratio_steps: next(of_ratios)?,
            column_scales: next(of_columns)?,
            core_steps: next(of_core)?,
            view_scales: next(of_views)?,
            light_scales: next(of_lights)?,
        })
    }
}
