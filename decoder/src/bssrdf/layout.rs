//! The `BSSR` header and the sizes of the sections that follow from it.

use super::addressing::Addressing;
use crate::container::bytes::{array_at, f32_at, u16_at, u32_at};
use crate::container::put;
use crate::error::{ReadError, Section};

/// Bytes of the `BSSR` section.
pub const HEADER_BYTES: usize = 32;
/// Code of per-pixel profiles.
pub const MODEL_PER_PIXEL: u8 = 0;
/// Codes of K base materials per pixel, which are K itself.
pub const MODELS_BMPP: [u8; 4] = [1, 2, 3, 5];
/// Code of two base materials per pixel.
pub const MODEL_2BMPP: u8 = 2;
/// Most base materials that a pixel has.
pub const MAX_PER_PIXEL: usize = 5;
/// Code of linear Rec. 709, the one colour space there is.
pub const LINEAR_REC709: u8 = 1;
/// Largest width and height in pixels.
pub const MAX_SIDE: u32 = 65_535;
/// Largest window radius in pixels.
pub const MAX_WINDOW_RADIUS: u16 = 1_023;
/// Largest number of nodes of a profile.
pub const MAX_SAMPLES: u16 = 4_096;
/// Most base materials where a pixel has several: indices are bytes.
pub const MAX_BASE_MATERIALS: u32 = 256;
/// Most base materials where a pixel has one.
pub const MAX_SINGLE_BASE_MATERIALS: u32 = 65_536;
/// Most pairs of a palette: their numbers have 11 bits.
pub const MAX_PAIRS: u16 = 2_048;
/// Largest 5-bit mixture ratio, which stands for 1.
pub const MAX_CODED_RATIO: u16 = 31;
/// How far the mixture ratios of a pixel may be from adding up to 1.
pub const SUM_TOLERANCE: f32 = 1.0 / 1024.0;
/// Largest magnitude of a log-scale profile value, so that e^±P̂ is finite and normal in f32.
pub const MAX_LOG: f32 = 87.0;
/// Smallest and largest pitch and radius in mm: nothing computed from them overflows.
pub const LENGTHS_MM: [f32; 2] = [1e-6, 1e6];
/// Largest refractive index.
pub const MAX_ETA: f32 = 4.0;

/// How the mixtures of a file are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coding {
    /// f32 ratios, and an index for each base material of a pixel.
    #[default]
    Exact,
    /// 2-BMPP with ratios in 8 bits: 24 bits per pixel.
    SmallRatios,
    /// 2-BMPP with a palette of pairs and ratios in 5 bits: 16 bits per pixel.
    Palette,
}

impl Coding {
    /// Its code in the header.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::Exact => 0,
            Self::SmallRatios => 1,
            Self::Palette => 2,
        }
    }

    fn from_code(code: u8) -> Option<Self> {
        [Self::Exact, Self::SmallRatios, Self::Palette].into_iter().find(|coding| coding.code() == code)
    }
}

/// What a BSSRDF file says of itself before its planes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Header {
    /// K, one of [`MODELS_BMPP`], or [`MODEL_PER_PIXEL`].
    pub model: u8,
    /// How mixtures are stored; [`Coding::Exact`] but for K = 2.
    pub coding: Coding,
    /// What lies beyond the border.
    pub addressing: Addressing,
    /// Pixels in x, 1 to 65,535.
    pub width: u32,
    /// Pixels in y, 1 to 65,535.
    pub height: u32,
    /// R: Rd is 0 for pixels further apart than this in x or in y.
    pub window_radius: u16,
    /// S, the nodes of a profile, 2 to 4,096; node h is at r = h · r_max / (S − 1).
    pub samples: u16,
    /// M, 1 to 256, or to 65,536 where K = 1; 0 for per-pixel profiles.
    pub base_materials: u32,
    /// Distance of neighbouring pixels in mm, 10⁻⁶ to 10⁶.
    pub pitch_mm: f32,
    /// Radius of the last node in mm, 10⁻⁶ to 10⁶; Rd is 0 beyond it.
    pub r_max_mm: f32,
    /// Refractive index of the material against air, 1 to 4.
    pub eta: f32,
}

impl Header {
    /// The section as it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; HEADER_BYTES] {
        let mut out = [0; HEADER_BYTES];
        put(&mut out, 0, &[self.model, LINEAR_REC709, self.addressing.code(), self.coding.code()]);
        put(&mut out, 4, &self.width.to_le_bytes());
        put(&mut out, 8, &self.height.to_le_bytes());
        put(&mut out, 12, &self.window_radius.to_le_bytes());
        put(&mut out, 14, &self.samples.to_le_bytes());
        put(&mut out, 16, &self.base_materials.to_le_bytes());
        put(&mut out, 20, &self.pitch_mm.to_le_bytes());
        put(&mut out, 24, &self.r_max_mm.to_le_bytes());
        put(&mut out, 28, &self.eta.to_le_bytes());
        out
    }

    /// Reads the section, which starts at `start` in the file.
    pub(crate) fn parse(section: &[u8], start: u64) -> Result<Self, ReadError> {
        let wrong_size = ReadError::WrongSize {
            section: Section::BssrdfHeader,
            need_bytes: HEADER_BYTES as u64,
            have_bytes: section.len() as u64,
        };
        if section.len() != HEADER_BYTES {
            return Err(wrong_size);
        }
        let bad_field = |at: u64, value: u32| ReadError::BadField {
            section: Section::BssrdfHeader,
            offset: start.saturating_add(at),
            value,
        };
        let integer = |at: u64, value: u32, min: u32, max: u32| {
            let inside = (min..=max).contains(&value);
            inside.then_some(value).ok_or(bad_field(at, value))
        };
        let number = |at: u64, value: f32, min: f32, max: f32| {
            let inside = (min..=max).contains(&value);
            inside.then_some(value).ok_or(ReadError::BadNumber {
                section: Section::BssrdfHeader,
                offset: start.saturating_add(at),
                value,
                min,
                max,
            })
        };
        let [model, colour_space, addressing, coding] = array_at(section, 0).ok_or(wrong_size)?;
        let u16s = |at| u16_at(section, at).ok_or(wrong_size);
        let u32s = |at| u32_at(section, at).ok_or(wrong_size);
        let f32s = |at| f32_at(section, at).ok_or(wrong_size);

        let materials = match model {
            MODEL_PER_PIXEL => 0..=0,
            1 => 1..=MAX_SINGLE_BASE_MATERIALS,
            2 | 3 | 5 => 1..=MAX_BASE_MATERIALS,
            other => return Err(bad_field(0, other.into())),
        };
        integer(1, colour_space.into(), LINEAR_REC709.into(), LINEAR_REC709.into())?;
        let bad_coding = bad_field(3, coding.into());
        let coding = Coding::from_code(coding).ok_or(bad_coding)?;
        if coding != Coding::Exact && model != MODEL_2BMPP {
            return Err(bad_coding);
        }
        let window_radius = u16s(12)?;
        integer(12, window_radius.into(), 0, MAX_WINDOW_RADIUS.into())?;
        let samples = u16s(14)?;
        integer(14, samples.into(), 2, MAX_SAMPLES.into())?;
        let [shortest, longest] = LENGTHS_MM;
        Ok(Self {
            model,
            coding,
            addressing: Addressing::from_code(addressing).ok_or(bad_field(2, addressing.into()))?,
            width: integer(4, u32s(4)?, 1, MAX_SIDE)?,
            height: integer(8, u32s(8)?, 1, MAX_SIDE)?,
            window_radius,
            samples,
            base_materials: integer(16, u32s(16)?, *materials.start(), *materials.end())?,
            pitch_mm: number(20, f32s(20)?, shortest, longest)?,
            r_max_mm: number(24, f32s(24)?, shortest, longest)?,
            eta: number(28, f32s(28)?, 1.0, MAX_ETA)?,
        })
    }

    /// N = width · height.
    #[must_use]
    pub fn pixels(&self) -> u64 {
        u64::from(self.width).saturating_mul(self.height.into())
    }

    /// Bytes of a base-material index.
    #[must_use]
    pub fn index_bytes(&self) -> u64 {
        if self.base_materials > MAX_BASE_MATERIALS { 2 } else { 1 }
    }

    /// Bytes that a section must have, as `FORMAT.md` says; 0 for those whose size does not follow from the header.
    #[must_use]
    pub fn section_bytes(&self, section: Section) -> u64 {
        let k = u64::from(self.model);
        let values = u64::from(self.samples).saturating_mul(3);
        let of_bases = values.saturating_mul(self.base_materials.into());
        match section {
            Section::BaseProfiles => of_bases.saturating_mul(4),
            Section::HalfProfiles => of_bases.saturating_mul(2),
            // The ratio of the second of two base materials is what the first leaves.
            Section::MixtureRatios if self.model == MODEL_2BMPP => self.pixels().saturating_mul(4),
            Section::MixtureRatios => self.pixels().saturating_mul(k).saturating_mul(4),
            Section::SmallRatios => self.pixels(),
            Section::BaseIndices => self.pixels().saturating_mul(k).saturating_mul(self.index_bytes()),
            Section::Codes => self.pixels().saturating_mul(2),
            Section::LocalProfiles => values.saturating_mul(4).saturating_mul(self.pixels()),
            _ => 0,
        }
    }
}
