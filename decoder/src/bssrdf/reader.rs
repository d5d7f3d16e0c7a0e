//! Parses and checks a BSSRDF file once; afterwards its planes are borrowed and nothing can fail.

use super::layout::{Header, MAX_LOG, MODEL_PER_PIXEL};
use crate::bytes::F32Le;
use crate::container::{Container, Crc};
use crate::error::{ReadError, Section};

/// A checked BSSRDF file.
#[derive(Clone, Copy, Debug)]
pub struct Bssrdf<'a> {
    header: Header,
    model: Model<'a>,
}

/// The planes of a file, by model.
#[derive(Clone, Copy, Debug)]
pub enum Model<'a> {
    /// 2-BMPP (Yatagawa et al. 2020, eq. 4 with K = 2).
    BaseMaterials(BaseMaterials<'a>),
    /// A profile for every pixel (Song et al. 2009).
    PerPixel(PerPixelProfiles<'a>),
}

/// The three planes of 2-BMPP, each of them one texture as it stands.
#[derive(Clone, Copy, Debug)]
pub struct BaseMaterials<'a> {
    /// Log-scale base scattering profiles P̂_b^h.
    ///
    /// Shape `[M][S][rgb]`; natural log of mm⁻², linear Rec. 709, in ±87.
    pub profiles: F32Le<'a>,
    /// Mixture ratio t of the first base material, 1 − t of the second.
    ///
    /// Shape `[height][width]`, in 0 to 1.
    pub ratios: F32Le<'a>,
    /// Base-material indices b₁, b₂.
    ///
    /// Shape `[height][width]`, each < M.
    pub indices: &'a [[u8; 2]],
}

/// The one section of per-pixel profiles.
#[derive(Clone, Copy, Debug)]
pub struct PerPixelProfiles<'a> {
    /// Log-scale local scattering profiles P̂_x^h.
    ///
    /// Shape `[S][rgb][height][width]`; natural log of mm⁻², linear Rec. 709, in ±87.
    pub profiles: F32Le<'a>,
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

        // Offset in the file and bytes of a section whose size follows from the header.
        let sized = |section| {
            let (entry, bytes) = container.section(section, crc)?;
            let need_bytes = header.section_bytes(section);
            if entry.length == need_bytes {
                Ok((entry.offset, bytes))
            } else {
                Err(ReadError::WrongSize { section, need_bytes, have_bytes: entry.length })
            }
        };
        let model = if header.model == MODEL_PER_PIXEL {
            Model::PerPixel(PerPixelProfiles {
                profiles: logs(Section::LocalProfiles, sized(Section::LocalProfiles)?)?,
            })
        } else {
            Model::BaseMaterials(BaseMaterials {
                profiles: logs(Section::BaseProfiles, sized(Section::BaseProfiles)?)?,
                ratios: ratios(sized(Section::MixtureRatios)?)?,
                indices: indices(sized(Section::BaseIndices)?, header.base_materials)?,
            })
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

/// Base-material indices, all less than `len`.
fn indices((start, bytes): (u64, &[u8]), len: u32) -> Result<&[[u8; 2]], ReadError> {
    let largest = bytes.iter().fold(0, |largest: u8, &index| largest.max(index));
    if u32::from(largest) < len {
        return Ok(bytes.as_chunks().0);
    }
    let first = bytes.iter().position(|&index| u32::from(index) >= len);
    let first = first.unwrap_or(0);
    Err(ReadError::IndexOutOfRange {
        section: Section::BaseIndices,
        offset: start.saturating_add(first as u64),
        index: bytes.get(first).copied().unwrap_or(largest).into(),
        len,
    })
}
