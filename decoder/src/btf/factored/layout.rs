//! `FACT`: sizes and steps of a Tucker decomposition.

use crate::btf::grid::Grid;
use crate::container::bytes::F32Le;
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

/// Bytes of the section before its stages.
pub(super) const FIXED_BYTES: usize = size_of::<FixedRecord>();
/// Bytes of a stage in the section.
pub(super) const STAGE_BYTES: usize = size_of::<StageRecord>();

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

    /// Bytes of the axes of views, the first part of `AXES`.
    pub(super) fn view_axes_len(&self, grid: &Grid) -> usize {
        usize::from(self.view_axes).saturating_mul(grid.view_nodes())
    }

    /// Bytes of `AXES`.
    pub(super) fn axes_bytes(&self, grid: &Grid) -> u64 {
        let of_lights = usize::from(self.light_axes).saturating_mul(grid.light_nodes());
        self.view_axes_len(grid).saturating_add(of_lights) as u64
    }

    /// Bytes of `INDX`.
    pub(super) fn indices_bytes(&self, texels: u32) -> u64 {
        u64::from(texels).saturating_mul(self.count.into())
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
            .to_bytes::<FIXED_BYTES>()
            .into_iter()
            .chain(self.stages().iter().flat_map(|stage| stage.record().to_bytes::<STAGE_BYTES>()))
    }

    /// Reads and checks the first bytes of the section.
    fn parse(section: SectionBytes<'_>, grid: &Grid) -> Result<Self, ReadError> {
        if section.bytes.len() < FIXED_BYTES {
            return Err(section.wrong_size(FIXED_BYTES as u64));
        }
        let mut shape = Self::parse_fixed(section, grid)?;
        let mut rest = section.from(FIXED_BYTES);
        for number in 0..usize::from(shape.count) {
            if rest.bytes.len() < STAGE_BYTES {
                return Err(section.wrong_size(stages_end(number.saturating_add(1)) as u64));
            }
            shape.parse_stage(number, rest)?;
            rest = rest.from(STAGE_BYTES);
        }
        Ok(shape)
    }

    /// Reads and checks what stands before the stages, which are left out.
    pub(super) fn parse_fixed(section: SectionBytes<'_>, grid: &Grid) -> Result<Self, ReadError> {
        use FixedRecord as R;
        let origin = section.origin;
        let R { luma, chroma, stages: count, view_axes, light_axes, .. } = R::from_bytes(section.bytes);
        let limit = |nodes: usize| u8::try_from(nodes).unwrap_or(u8::MAX).into();
        origin.integer(offset_of!(R, luma), luma, 1..=MAX_LUMA.into())?;
        origin.integer(offset_of!(R, chroma), chroma, 0..=MAX_CHROMA.into())?;
        origin.integer(offset_of!(R, stages), count, 1..=MOST_STAGES.into())?;
        origin.integer(offset_of!(R, view_axes), view_axes, 1..=limit(grid.view_nodes()))?;
        origin.integer(offset_of!(R, light_axes), light_axes, 1..=limit(grid.light_nodes()))?;
        Ok(Self { luma, chroma, view_axes, light_axes, stages: [CodewordStage::default(); MAX_STAGES], count })
    }

    /// Reads and checks stage `number`.
    pub(super) fn parse_stage(&mut self, number: usize, section: SectionBytes<'_>) -> Result<(), ReadError> {
        let coefficients = self.coefficients();
        if let Some(stage) = self.stages.get_mut(number) {
            *stage = CodewordStage::parse(section, coefficients)?;
        }
        Ok(())
    }

    /// Numbers in the lists of steps and scales, in file order.
    pub(super) fn lengths(&self) -> [usize; 5] {
        [2, self.columns(), self.columns(), self.view_axes.into(), self.light_axes.into()]
    }

    /// Bytes of the section.
    pub(super) fn section_bytes(&self) -> u64 {
        let numbers = self.lengths().into_iter().fold(0, usize::saturating_add);
        stages_end(self.count.into()).saturating_add(numbers.saturating_mul(size_of::<f32>())) as u64
    }
}

/// Bytes of the section up to the end of its first `stages` stages.
pub(super) fn stages_end(stages: usize) -> usize {
    stages.saturating_mul(STAGE_BYTES).saturating_add(FIXED_BYTES)
}

impl CodewordStage {
    fn record(self) -> StageRecord {
        let Self { words, first, count } = self;
        let codewords_less_one = u8::try_from(words.wrapping_sub(1)).unwrap_or(u8::MAX);
        StageRecord { codewords_less_one, first, count, reserved: 0 }
    }

    /// Reads and checks the record that a section begins with.
    fn parse(section: SectionBytes<'_>, coefficients: usize) -> Result<Self, ReadError> {
        let StageRecord { codewords_less_one, first, count, .. } = StageRecord::from_bytes(section.bytes);
        if count == 0 || usize::from(first).wrapping_add(count.into()) > coefficients {
            return Err(section.origin.bad_field(offset_of!(StageRecord, count), count));
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
        let shape = TuckerShape::parse(section, grid)?;
        let lengths = shape.lengths();
        let mut rest = section.sized(shape.section_bytes())?.from(stages_end(shape.count.into()));
        let mut next = |length: usize| {
            let bytes = length.saturating_mul(size_of::<f32>());
            let steps = SectionBytes { bytes: rest.bytes.get(..bytes).unwrap_or(&[]), ..rest };
            rest = rest.from(bytes);
            checked_steps(steps)
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

/// Steps and scales, all within their range.
pub(super) fn checked_steps(section: SectionBytes<'_>) -> Result<F32Le<'_>, ReadError> {
    let steps = F32Le::new(section.bytes);
    for (number, value) in steps.iter().enumerate() {
        section.origin.at_item(number, size_of::<f32>()).number(0, value, STEPS)?;
    }
    Ok(steps)
}
