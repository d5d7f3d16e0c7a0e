//! The `BSSR` header and the sizes of the sections that follow from it.

use super::addressing::Addressing;
use crate::container::record::{Field, record};
use crate::container::sections::SectionBytes;
use crate::error::ReadError;
use crate::section::Section;
use core::mem::offset_of;
use core::num::Saturating;

/// Bytes of the `BSSR` section.
pub const HEADER_BYTES: usize = size_of::<HeaderRecord>();
/// Code of per-pixel profiles.
pub const MODEL_PER_PIXEL: u8 = 0;
/// Codes of K base materials per pixel, which are K itself.
pub const MODELS_BMPP: [u8; 4] = [1, 2, 3, 5];
/// Code of two base materials per pixel.
pub const MODEL_2BMPP: u8 = 2;
/// Largest number of base materials of a pixel.
pub const MAX_PER_PIXEL: usize = 5;
/// Code of linear Rec. 709, the one colour space there is.
pub const LINEAR_REC709: u8 = 1;
/// Largest width and height in pixels.
pub const MAX_SIDE: u32 = 65_535;
/// Largest window radius in pixels.
pub const MAX_WINDOW_RADIUS: u16 = 1_023;
/// Largest number of nodes of a profile.
pub const MAX_SAMPLES: u16 = 4_096;
/// Largest number of base materials where a pixel has several: indices are bytes.
pub const MAX_BASE_MATERIALS: u32 = 256;
/// Largest number of base materials where a pixel has one.
pub const MAX_SINGLE_BASE_MATERIALS: u32 = 65_536;
/// Largest number of pairs of a palette: their numbers have 11 bits.
pub const MAX_PAIRS: u16 = 2_048;
/// Largest 5-bit mixture ratio, which stands for 1.
pub const MAX_CODED_RATIO: u16 = 31;
/// Largest distance of the sum of a pixel's mixture ratios from 1.
pub const SUM_TOLERANCE: f32 = 1.0 / 1024.0;
/// Largest magnitude of a log-scale profile value, so that e^±P̂ is finite and normal in f32.
pub const MAX_LOG: f32 = 87.0;
/// Smallest and largest pitch and radius in mm: nothing computed from them overflows.
pub const LENGTHS_MM: [f32; 2] = [1e-6, 1e6];
/// Largest refractive index.
pub const MAX_ETA: f32 = 4.0;

/// Encoding of the mixtures of a file.
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
    /// Code in the header.
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

/// Pairs of a palette whose section has a number of bytes.
pub(super) fn pairs_in(bytes: u64) -> Result<u16, ReadError> {
    const PAIR_BYTES: u64 = 2;
    let most = u64::from(MAX_PAIRS).saturating_mul(PAIR_BYTES);
    match u16::try_from(bytes / PAIR_BYTES) {
        Ok(pairs @ 1..=MAX_PAIRS) if bytes.is_multiple_of(PAIR_BYTES) => Ok(pairs),
        _ => Err(ReadError::WrongSize { section: Section::Pairs, need_bytes: most, have_bytes: bytes }),
    }
}

record! {
    /// The `BSSR` section (`FORMAT.md`, section 2.1).
    HeaderRecord {
        model: u8,
        colour_space: u8,
        addressing: u8,
        coding: u8,
        width: u32,
        height: u32,
        window_radius: u16,
        samples: u16,
        base_materials: u32,
        pitch_mm: f32,
        r_max_mm: f32,
        eta: f32,
    }
}

/// Header of a BSSRDF file: sizes, units and model of the planes that follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BssrdfHeader {
    /// K, one of [`MODELS_BMPP`], or [`MODEL_PER_PIXEL`].
    pub model: u8,
    /// Encoding of mixtures; [`Coding::Exact`] but for K = 2.
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

impl BssrdfHeader {
    /// The section as it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; HEADER_BYTES] {
        let Self { model, coding, addressing, width, height, .. } = *self;
        HeaderRecord {
            model,
            colour_space: LINEAR_REC709,
            addressing: addressing.code(),
            coding: coding.code(),
            width,
            height,
            window_radius: self.window_radius,
            samples: self.samples,
            base_materials: self.base_materials,
            pitch_mm: self.pitch_mm,
            r_max_mm: self.r_max_mm,
            eta: self.eta,
        }
        .to_bytes()
    }

    /// Reads and checks the section.
    pub(crate) fn parse(section: SectionBytes<'_>) -> Result<Self, ReadError> {
        use HeaderRecord as R;
        let record = R::from_bytes(section.at_least(HEADER_BYTES as u64)?.bytes);
        let origin = section.origin;

        let R { model, colour_space, addressing, coding, .. } = record;
        let materials = match model {
            MODEL_PER_PIXEL => 0..=0,
            1 => 1..=MAX_SINGLE_BASE_MATERIALS,
            2 | 3 | 5 => 1..=MAX_BASE_MATERIALS,
            other => return Err(origin.bad_field(offset_of!(R, model), other)),
        };
        let rec709 = LINEAR_REC709.into();
        origin.integer(offset_of!(R, colour_space), colour_space, rec709..=rec709)?;
        let bad_coding = origin.bad_field(offset_of!(R, coding), coding);
        let coding = Coding::from_code(coding).ok_or(bad_coding)?;
        if coding != Coding::Exact && model != MODEL_2BMPP {
            return Err(bad_coding);
        }
        let bad_addressing = origin.bad_field(offset_of!(R, addressing), addressing);
        Ok(Self {
            model,
            coding,
            window_radius: origin.integer(
                offset_of!(R, window_radius),
                record.window_radius,
                0..=MAX_WINDOW_RADIUS.into(),
            )?,
            samples: origin.integer(offset_of!(R, samples), record.samples, 2..=MAX_SAMPLES.into())?,
            addressing: Addressing::from_code(addressing).ok_or(bad_addressing)?,
            width: origin.integer(offset_of!(R, width), record.width, 1..=MAX_SIDE)?,
            height: origin.integer(offset_of!(R, height), record.height, 1..=MAX_SIDE)?,
            base_materials: origin.integer(offset_of!(R, base_materials), record.base_materials, materials)?,
            pitch_mm: origin.number(offset_of!(R, pitch_mm), record.pitch_mm, LENGTHS_MM)?,
            r_max_mm: origin.number(offset_of!(R, r_max_mm), record.r_max_mm, LENGTHS_MM)?,
            eta: origin.number(offset_of!(R, eta), record.eta, [1.0, MAX_ETA])?,
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
        const RGB: Saturating<u64> = Saturating(3);
        const F32: Saturating<u64> = Saturating(4);
        const TWO_BYTES: Saturating<u64> = Saturating(2);
        let [n, k, m, s] = [self.pixels(), self.model.into(), self.base_materials.into(), self.samples.into()];
        let [n, k, m, s] = [n, k, m, s].map(Saturating);
        let bytes = match section {
            Section::BaseProfiles => m * s * RGB * F32,
            Section::HalfProfiles => m * s * RGB * TWO_BYTES,
            // The ratio of the second of two base materials is what the first leaves.
            Section::MixtureRatios if self.model == MODEL_2BMPP => n * F32,
            Section::MixtureRatios => k * n * F32,
            Section::SmallRatios => n,
            Section::BaseIndices => k * n * Saturating(self.index_bytes()),
            Section::Codes => n * TWO_BYTES,
            Section::LocalProfiles => s * RGB * n * F32,
            _ => Saturating(0),
        };
        bytes.0
    }
}
