//! Parses and checks a BSSRDF file once; afterwards its planes are borrowed and nothing can fail.

use super::layout::{Coding, Header, MAX_LOG, MAX_PAIRS, MODEL_2BMPP, MODEL_PER_PIXEL, SUM_TOLERANCE};
use super::planes::{BaseMaterials, Mixtures, Model, PerPixelProfiles, Profiles, split_code};
use crate::container::bytes::{F16Le, F32Le, U16Le};
use crate::container::{Container, Crc};
use crate::error::{ReadError, Section};

/// A checked BSSRDF file.
#[derive(Clone, Copy, Debug)]
pub struct Bssrdf<'a> {
    header: Header,
    model: Model<'a>,
}

impl<'a> Bssrdf<'a> {
    /// Reads and checks a file: structure, sizes, every value and index, and all CRCs.
    ///
    /// # Errors
    /// The first thing that is wrong, with section, offset and numbers.
    pub fn parse(file: &'a [u8]) -> Result<Self, ReadError> {
        Self::parse_with(file, Crc::Check)
    }

    /// [`Bssrdf::parse`] with a choice about the sections' CRC-32.
    ///
    /// # Errors
    /// As [`Bssrdf::parse`].
    pub fn parse_with(file: &'a [u8], crc: Crc) -> Result<Self, ReadError> {
        let container = Container::parse(file)?;
        let (entry, bytes) = container.section(Section::BssrdfHeader, crc)?;
        let header = Header::parse(bytes, entry.offset)?;

        let sections = Sections { container: &container, header: &header, crc };
        let model = if header.model == MODEL_PER_PIXEL {
            Model::PerPixel(PerPixelProfiles {
                profiles: logs(Section::LocalProfiles, sections.sized(Section::LocalProfiles)?)?,
            })
        } else {
            Model::BaseMaterials(BaseMaterials { profiles: sections.profiles()?, mixtures: sections.mixtures()? })
        };
        Ok(Self { header, model })
    }

    /// Size, pitch, window and so on.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The planes, for upload.
    #[must_use]
    pub fn model(&self) -> &Model<'a> {
        &self.model
    }
}

/// The sections of a file whose header is known.
struct Sections<'a, 'b> {
    container: &'b Container<'a>,
    header: &'b Header,
    crc: Crc,
}

impl<'a> Sections<'a, '_> {
    /// Offset in the file and bytes of a section whose size follows from the header.
    fn sized(&self, section: Section) -> Result<(u64, &'a [u8]), ReadError> {
        let (entry, bytes) = self.container.section(section, self.crc)?;
        let need_bytes = self.header.section_bytes(section);
        if entry.length == need_bytes {
            Ok((entry.offset, bytes))
        } else {
            Err(ReadError::WrongSize { section, need_bytes, have_bytes: entry.length })
        }
    }

    /// Half floats if they are there, single ones otherwise.
    fn profiles(&self) -> Result<Profiles<'a>, ReadError> {
        if self.container.entries().any(|entry| entry.section == Section::HalfProfiles) {
            return half_logs(self.sized(Section::HalfProfiles)?).map(Profiles::F16);
        }
        logs(Section::BaseProfiles, self.sized(Section::BaseProfiles)?).map(Profiles::F32)
    }

    fn mixtures(&self) -> Result<Mixtures<'a>, ReadError> {
        let materials = self.header.base_materials;
        let bytes_of = |section| indices(section, self.sized(section)?, materials);
        Ok(match (self.header.coding, self.header.model) {
            (Coding::Palette, _) => {
                let pairs = self.pairs()?;
                let codes = codes(self.sized(Section::Codes)?, pairs.len())?;
                Mixtures::Palette { pairs, codes }
            }
            (Coding::SmallRatios, _) => Mixtures::TwoSmall {
                ratios: self.sized(Section::SmallRatios)?.1,
                indices: bytes_of(Section::BaseIndices)?.as_chunks().0,
            },
            (Coding::Exact, MODEL_2BMPP) => Mixtures::Two {
                ratios: ratios(self.sized(Section::MixtureRatios)?)?,
                indices: bytes_of(Section::BaseIndices)?.as_chunks().0,
            },
            (Coding::Exact, 1) if self.header.index_bytes() == 1 => Mixtures::One(bytes_of(Section::BaseIndices)?),
            (Coding::Exact, 1) => Mixtures::OneOfMany(wide_indices(self.sized(Section::BaseIndices)?, materials)?),
            (Coding::Exact, count) => {
                let count = usize::from(count);
                let (start, bytes) = self.sized(Section::MixtureRatios)?;
                let ratios = ratios((start, bytes))?;
                check_sums(start, ratios, count)?;
                Mixtures::Several { ratios, indices: bytes_of(Section::BaseIndices)?, count }
            }
        })
    }

    /// The palette, whose length its section's size tells.
    fn pairs(&self) -> Result<&'a [[u8; 2]], ReadError> {
        let section = Section::Pairs;
        let (entry, bytes) = self.container.section(section, self.crc)?;
        let limit = u64::from(MAX_PAIRS).saturating_mul(2);
        if entry.length == 0 || entry.length > limit || !entry.length.is_multiple_of(2) {
            return Err(ReadError::WrongSize { section, need_bytes: limit, have_bytes: entry.length });
        }
        Ok(indices(section, (entry.offset, bytes), self.header.base_materials)?.as_chunks().0)
    }
}

/// Values of `section`, all within ±[`MAX_LOG`].
fn logs(section: Section, (start, bytes): (u64, &[u8])) -> Result<F32Le<'_>, ReadError> {
    let values = F32Le::new(bytes);
    // Without its sign an f32 orders as an integer, NaN and infinity last.
    let outside = |bits: i32| MAX_LOG_BITS.wrapping_sub(bits & i32::MAX);
    check(section, start, values, outside, -MAX_LOG, MAX_LOG)
}

/// Mixture ratios, all within 0 to 1.
fn ratios((start, bytes): (u64, &[u8])) -> Result<F32Le<'_>, ReadError> {
    let values = F32Le::new(bytes);
    // The sign bit set: negative (or −0) before the subtraction, above 1 after it.
    let outside = |bits: i32| bits | ONE_BITS.wrapping_sub(bits);
    check(Section::MixtureRatios, start, values, outside, 0.0, 1.0)
}

const MAX_LOG_BITS: i32 = MAX_LOG.to_bits().cast_signed();
const ONE_BITS: i32 = 1.0_f32.to_bits().cast_signed();

/// Refuses `values` if `outside` gives a negative number for the bits of any of them.
fn check<'a>(
    section: Section,
    start: u64,
    values: F32Le<'a>,
    outside: impl Fn(i32) -> i32,
    min: f32,
    max: f32,
) -> Result<F32Le<'a>, ReadError> {
    if !values.any_negative(&outside) {
        return Ok(values);
    }
    // Something is wrong: now find out where.
    let at = values.bits().position(|bits| outside(bits) < 0);
    let at = at.unwrap_or(0);
    Err(ReadError::BadNumber {
        section,
        offset: start.saturating_add((at as u64).saturating_mul(4)),
        value: values.get(at).unwrap_or(0.0),
        min,
        max,
    })
}

/// Half-float values of [`Section::HalfProfiles`], all within ±[`MAX_LOG`].
fn half_logs((start, bytes): (u64, &[u8])) -> Result<F16Le<'_>, ReadError> {
    /// 87, which a half float holds exactly.
    const LIMIT: u16 = 0x5570;
    let values = F16Le::new(bytes);
    // Without its sign a half float orders as an integer, NaN and infinity last.
    match values.bits().position(|bits| bits & 0x7FFF > LIMIT) {
        None => Ok(values),
        Some(at) => Err(ReadError::BadNumber {
            section: Section::HalfProfiles,
            offset: start.saturating_add((at as u64).saturating_mul(2)),
            value: values.get(at).unwrap_or(0.0),
            min: -MAX_LOG,
            max: MAX_LOG,
        }),
    }
}

/// Refuses planes of `count` ratios whose sums are not 1: mixtures are convex, and profiles stay in their range.
fn check_sums(start: u64, ratios: F32Le<'_>, count: usize) -> Result<(), ReadError> {
    let pixels = ratios.len().checked_div(count).unwrap_or(0);
    let sum = |pixel: usize| -> f32 {
        (0..count).map(|k| ratios.get(k.saturating_mul(pixels).saturating_add(pixel)).unwrap_or(0.0)).sum()
    };
    let (min, max) = (1.0 - SUM_TOLERANCE, 1.0 + SUM_TOLERANCE);
    match (0..pixels).find(|&pixel| !(min..=max).contains(&sum(pixel))) {
        None => Ok(()),
        Some(pixel) => Err(ReadError::BadNumber {
            section: Section::MixtureRatios,
            offset: start.saturating_add((pixel as u64).saturating_mul(4)),
            value: sum(pixel),
            min,
            max,
        }),
    }
}

/// Base-material indices of `section`, all less than `len`.
fn indices(section: Section, (start, bytes): (u64, &[u8]), len: u32) -> Result<&[u8], ReadError> {
    let largest = bytes.iter().fold(0, |largest: u8, &index| largest.max(index));
    if u32::from(largest) < len {
        return Ok(bytes);
    }
    let first = bytes.iter().position(|&index| u32::from(index) >= len);
    let first = first.unwrap_or(0);
    Err(ReadError::IndexOutOfRange {
        section,
        offset: start.saturating_add(first as u64),
        index: bytes.get(first).copied().unwrap_or(largest).into(),
        len,
    })
}

/// 16-bit base-material indices, all less than `len`.
fn wide_indices(section: (u64, &[u8]), len: u32) -> Result<U16Le<'_>, ReadError> {
    numbers(Section::BaseIndices, section, len, u32::from)
}

/// Palette codes, all of whose pairs are among `len`.
fn codes(section: (u64, &[u8]), len: usize) -> Result<U16Le<'_>, ReadError> {
    let len = u32::try_from(len).unwrap_or(u32::MAX);
    numbers(Section::Codes, section, len, |code| split_code(code).0.into())
}

/// 16-bit values whose `number` is less than `len`.
fn numbers(
    section: Section,
    (start, bytes): (u64, &[u8]),
    len: u32,
    number: impl Fn(u16) -> u32,
) -> Result<U16Le<'_>, ReadError> {
    let values = U16Le::new(bytes);
    match values.iter().position(|value| number(value) >= len) {
        None => Ok(values),
        Some(at) => Err(ReadError::IndexOutOfRange {
            section,
            offset: start.saturating_add((at as u64).saturating_mul(2)),
            index: values.get(at).map_or(0, number),
            len,
        }),
    }
}
