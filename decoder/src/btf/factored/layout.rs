//! `FACT`: numbers and steps of factors.

use crate::btf::grid::Grid;
use crate::container::bytes::{F32Le, array_at};
use crate::error::{ReadError, Section};

/// Most stages of codewords.
pub const MAX_STAGES: usize = MOST_STAGES as usize;
/// The same as files count them.
const MOST_STAGES: u8 = 32;
/// Most components of luma.
pub const MAX_LUMA: u8 = 128;
/// Most components of chroma.
pub const MAX_CHROMA: u8 = 32;
/// Most coefficients of a texel.
pub const MAX_COEFFICIENTS: usize = 2 + MAX_CHROMA as usize + MAX_LUMA as usize;
/// Most columns of tables.
pub const MAX_COLUMNS: usize = 2 * MAX_CHROMA as usize + MAX_LUMA as usize;
/// Largest step, of anything.
pub const MAX_STEP: f32 = 1e6;
/// Bytes before the stages.
pub(super) const FIXED_BYTES: usize = 8;
/// Bytes of a stage.
const STAGE_BYTES: usize = 4;

/// One stage of codewords.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stage {
    /// Number of codewords, 1 to 256.
    pub words: u16,
    /// The first coefficient that they add to.
    pub first: u8,
    /// How many coefficients they add to, at least 1.
    pub count: u8,
}

impl Stage {
    /// Numbers in all of its codewords.
    #[must_use]
    pub fn numbers(&self) -> usize {
        usize::from(self.words).wrapping_mul(self.count.into())
    }
}

/// Numbers of everything in a file of factors.
///
/// A texel has the coefficients ρ_Cr, ρ_Cb, those of chroma, those of luma. Tables have columns of luma, of the first
/// channel of chroma, of the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Components of luma, 1 to 128.
    pub luma: u8,
    /// Components of chroma, 0 to 32.
    pub chroma: u8,
    /// Axes of views, 1 to 255.
    pub view_axes: u8,
    /// Axes of lights, 1 to 255.
    pub light_axes: u8,
    /// Stages of codewords, the first `count` used.
    pub stages: [Stage; MAX_STAGES],
    /// How many are used, 1 to 32.
    pub count: u8,
}

impl Shape {
    /// Coefficients of a texel.
    #[must_use]
    pub fn coefficients(&self) -> usize {
        usize::from(self.luma).wrapping_add(self.chroma.into()).wrapping_add(2)
    }

    /// Columns of tables.
    #[must_use]
    pub fn columns(&self) -> usize {
        usize::from(self.luma).wrapping_add(usize::from(self.chroma) << 1)
    }

    /// The stages that are used.
    #[must_use]
    pub fn stages(&self) -> &[Stage] {
        self.stages.get(..usize::from(self.count)).unwrap_or(&[])
    }

    /// The section's first bytes, which its numbers follow.
    pub fn to_bytes(&self) -> impl Iterator<Item = u8> + '_ {
        let fixed = [self.luma, self.chroma, self.count, 0, self.view_axes, self.light_axes, 0, 0];
        let stage = |stage: &Stage| [stage.words.wrapping_sub(1).to_le_bytes()[0], stage.first, stage.count, 0];
        fixed.into_iter().chain(self.stages().iter().flat_map(stage))
    }
}

/// What `FACT` says.
#[derive(Clone, Copy, Debug)]
pub struct Factors<'a> {
    /// Numbers of everything.
    pub shape: Shape,
    /// ρ of one step, for both channels.
    pub ratio_steps: F32Le<'a>,
    /// Value of one step of a coefficient times one step of a table, by columns.
    pub factors: F32Le<'a>,
    /// Steps of a table that one step of the core is, by columns.
    pub core_steps: F32Le<'a>,
    /// One step of an axis of views.
    pub view_scales: F32Le<'a>,
    /// One step of an axis of lights.
    pub light_scales: F32Le<'a>,
}

impl<'a> Factors<'a> {
    /// Reads and checks the section, which begins at `start` of the file.
    pub(super) fn parse(bytes: &'a [u8], start: u64, grid: &Grid) -> Result<Self, ReadError> {
        let section = Section::Factors;
        let wrong_size = |need: usize| {
            let (need_bytes, have_bytes) = (need as u64, bytes.len() as u64);
            ReadError::WrongSize { section, need_bytes, have_bytes }
        };
        let field = |at: usize, value: u8| {
            let offset = start.saturating_add(at as u64);
            ReadError::BadField { section, offset, value: value.into() }
        };
        let [luma, chroma, count, _, view_axes, light_axes, ..] =
            array_at::<FIXED_BYTES>(bytes, 0).ok_or(wrong_size(FIXED_BYTES))?;
        let limit = |nodes: usize| u8::try_from(nodes).unwrap_or(u8::MAX);
        let ranges = [
            (0, luma, 1, MAX_LUMA),
            (1, chroma, 0, MAX_CHROMA),
            (2, count, 1, MOST_STAGES),
            (4, view_axes, 1, limit(grid.view_nodes())),
            (5, light_axes, 1, limit(grid.light_nodes())),
        ];
        for (at, value, least, most) in ranges {
            if !(least..=most).contains(&value) {
                return Err(field(at, value));
            }
        }
        let mut shape = Shape { luma, chroma, view_axes, light_axes, stages: [Stage::default(); MAX_STAGES], count };
        let coefficients = shape.coefficients();
        let mut at = FIXED_BYTES;
        for stage in shape.stages.iter_mut().take(count.into()) {
            let [words, first, count, _] = array_at(bytes, at).ok_or(wrong_size(at.saturating_add(STAGE_BYTES)))?;
            *stage = Stage { words: u16::from(words).wrapping_add(1), first, count };
            if count == 0 || usize::from(first).wrapping_add(count.into()) > coefficients {
                return Err(field(at.saturating_add(2), count));
            }
            at = at.saturating_add(STAGE_BYTES);
        }
        let lengths = [2, shape.columns(), shape.columns(), view_axes.into(), light_axes.into()];
        let need = lengths.iter().fold(at, |end, length| end.saturating_add(length << 2));
        if bytes.len() != need {
            return Err(wrong_size(need));
        }
        let mut next = |length: usize| {
            let end = at.saturating_add(length << 2);
            let numbers = F32Le::new(bytes.get(at..end).unwrap_or(&[]));
            let least = 0.0;
            let wrong = numbers.iter().enumerate().find(|(_, value)| !(least..=MAX_STEP).contains(value));
            let offset = start.saturating_add(at as u64);
            at = end;
            match wrong {
                None => Ok(numbers),
                Some((number, value)) => {
                    let offset = offset.saturating_add((number as u64) << 2);
                    Err(ReadError::BadNumber { section, offset, value, min: least, max: MAX_STEP })
                }
            }
        };
        let [of_ratios, of_factors, of_core, of_views, of_lights] = lengths;
        Ok(Self {
            shape,
            ratio_steps: next(of_ratios)?,
            factors: next(of_factors)?,
            core_steps: next(of_core)?,
            view_scales: next(of_views)?,
            light_scales: next(of_lights)?,
        })
    }
}
