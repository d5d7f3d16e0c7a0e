//! The `sepb` section: L and A, and the sizes and ranges that follow from them.

use crate::container::record::{Field, record};
use crate::container::sections::SectionBytes;
use crate::error::ReadError;
use core::mem::offset_of;

/// Largest L: two maps and the two sums of them are the four targets that every device draws to at once.
pub const MAX_TERMS: usize = 2;
/// Largest number of pairs l ≤ m.
pub const MAX_PAIRS_OF_TERMS: usize = 3;
/// Largest A.
pub const MAX_GAUSSIANS: usize = 8;
/// Smallest and largest width σ in pixels.
pub const WIDTHS: [f32; 2] = [0.125, 1_023.0];
/// Largest first width in pixels, and largest factor from one width to the next: taps of a blur stay few.
pub(super) const MAX_STEP: f32 = 16.0;
/// Largest magnitude of a weight w.
pub const MAX_WEIGHT: f32 = 1e6;
/// Largest magnitude of a factor d in mm: coefficients of any profile stay finite.
pub const MAX_PROJECTION: f32 = 1e15;
/// Bytes before the numbers.
pub(super) const HEADER_BYTES: usize = size_of::<BasisRecord>();
/// Colour channels.
const RGB: u64 = 3;
/// Bytes of a number.
const F32: u64 = 4;

record! {
    /// Start of the `sepb` section.
    BasisRecord {
        terms: u8,
        gaussians: u8,
        reserved: u16,
    }
}

/// Size of a separable basis: L and A.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BasisSize {
    /// L, the number of maps, 1 to [`MAX_TERMS`].
    pub terms: usize,
    /// A, the number of Gaussians, 1 to [`MAX_GAUSSIANS`].
    pub gaussians: usize,
}

impl BasisSize {
    /// Whether L and A are in range.
    #[must_use]
    pub fn is_in_range(self) -> bool {
        (1..=MAX_TERMS).contains(&self.terms) && (1..=MAX_GAUSSIANS).contains(&self.gaussians)
    }

    /// Number of pairs l ≤ m, L (L + 1) / 2.
    #[must_use]
    pub fn pairs(self) -> usize {
        if self.terms == 1 { 1 } else { MAX_PAIRS_OF_TERMS }
    }

    /// Number of the pair of l and m, in either order: (0, 0), (0, 1), (1, 1).
    #[must_use]
    pub fn pair(self, l: usize, m: usize) -> usize {
        l.saturating_add(m).min(self.pairs().saturating_sub(1))
    }

    /// Bytes of the section for profiles of `samples` nodes.
    #[must_use]
    pub fn section_bytes(self, samples: u16) -> u64 {
        let [l, a, pairs] = [self.terms, self.gaussians, self.pairs()].map(|count| count as u64);
        let weights = pairs.saturating_mul(a).saturating_mul(RGB);
        let projection = l.saturating_mul(samples.into()).saturating_mul(RGB);
        let numbers = a.saturating_add(weights).saturating_add(projection);
        numbers.saturating_mul(F32).saturating_add(HEADER_BYTES as u64)
    }

    /// First bytes of the section.
    #[must_use]
    pub fn to_bytes(self) -> [u8; HEADER_BYTES] {
        let byte = |count: usize| u8::try_from(count).unwrap_or(u8::MAX);
        BasisRecord { terms: byte(self.terms), gaussians: byte(self.gaussians), reserved: 0 }.to_bytes()
    }

    /// Reads and checks L and A.
    pub(super) fn parse(section: SectionBytes<'_>) -> Result<Self, ReadError> {
        use BasisRecord as R;
        if section.bytes.len() < HEADER_BYTES {
            return Err(section.wrong_size(HEADER_BYTES as u64));
        }
        let R { terms, gaussians, .. } = R::from_bytes(section.bytes);
        let origin = section.origin;
        let up_to = |most: usize| 1..=u32::try_from(most).unwrap_or(0);
        let terms = origin.integer(offset_of!(R, terms), terms, up_to(MAX_TERMS))?;
        let gaussians = origin.integer(offset_of!(R, gaussians), gaussians, up_to(MAX_GAUSSIANS))?;
        Ok(Self { terms: terms.into(), gaussians: gaussians.into() })
    }
}
