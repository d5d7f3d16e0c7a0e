//! Checks of the values in the planes: logarithms, ratios and indices, each in its range.

use super::layout::{MAX_LOG, SUM_TOLERANCE};
use super::planes::split_code;
use crate::container::bytes::{F16Le, F32Le, U16Le};
use crate::container::index::row_major;
use crate::container::origin::Origin;
use crate::container::sections::SectionBytes;
use crate::error::ReadError;

/// Range of log-scale profile values.
const LOGS: [f32; 2] = [-MAX_LOG, MAX_LOG];
const MAX_LOG_BITS: i32 = MAX_LOG.to_bits().cast_signed();
const ONE_BITS: i32 = 1.0_f32.to_bits().cast_signed();

/// Log-scale values, all within ±[`MAX_LOG`].
pub(super) fn logs(section: SectionBytes<'_>) -> Result<F32Le<'_>, ReadError> {
    // Without its sign an f32 orders as an integer, NaN and infinity last.
    let outside = |bits: i32| MAX_LOG_BITS.wrapping_sub(bits & i32::MAX);
    check(section, outside, LOGS)
}

/// Mixture ratios, all within 0 to 1.
pub(super) fn ratios(section: SectionBytes<'_>) -> Result<F32Le<'_>, ReadError> {
    // The sign bit set: negative (or −0) before the subtraction, above 1 after it.
    let outside = |bits: i32| bits | ONE_BITS.wrapping_sub(bits);
    check(section, outside, [0.0, 1.0])
}

/// Refuses values if `outside` gives a negative number for the bits of any of them.
fn check(section: SectionBytes<'_>, outside: impl Fn(i32) -> i32, range: [f32; 2]) -> Result<F32Le<'_>, ReadError> {
    let values = F32Le::new(section.bytes);
    if !values.any_negative(&outside) {
        return Ok(values);
    }
    // Something is wrong: now find out where.
    let at = values.bits().position(|bits| outside(bits) < 0).unwrap_or(0);
    Err(section.origin.at_item(at, size_of::<f32>()).bad_number(values.get(at).unwrap_or(0.0), range))
}

/// Log-scale values as half floats, all within ±[`MAX_LOG`].
pub(super) fn half_logs(section: SectionBytes<'_>) -> Result<F16Le<'_>, ReadError> {
    /// 87, which a half float holds exactly.
    const LIMIT: u16 = 0x5570;
    let values = F16Le::new(section.bytes);
    // Without its sign a half float orders as an integer, NaN and infinity last.
    match values.bits().position(|bits| bits & 0x7FFF > LIMIT) {
        None => Ok(values),
        Some(at) => Err(section.origin.at_item(at, size_of::<u16>()).bad_number(values.get(at).unwrap_or(0.0), LOGS)),
    }
}

/// Refuses `count` planes of ratios whose sums are not 1: mixtures are convex, and profiles stay in their range.
pub(super) fn check_sums(origin: Origin, ratios: F32Le<'_>, count: usize) -> Result<(), ReadError> {
    let pixels = ratios.len().checked_div(count).unwrap_or(0);
    let sum =
        |pixel: usize| -> f32 { (0..count).map(|k| ratios.get(row_major(k, pixels, pixel)).unwrap_or(0.0)).sum() };
    let [min, max] = [1.0 - SUM_TOLERANCE, 1.0 + SUM_TOLERANCE];
    match (0..pixels).find(|&pixel| !(min..=max).contains(&sum(pixel))) {
        None => Ok(()),
        Some(pixel) => Err(origin.at_item(pixel, size_of::<f32>()).bad_number(sum(pixel), [min, max])),
    }
}

/// Base-material indices, all less than `len`.
pub(super) fn indices(section: SectionBytes<'_>, len: u32) -> Result<&[u8], ReadError> {
    let bytes = section.bytes;
    let largest = bytes.iter().fold(0, |largest: u8, &index| largest.max(index));
    if u32::from(largest) < len {
        return Ok(bytes);
    }
    let first = bytes.iter().position(|&index| u32::from(index) >= len).unwrap_or(0);
    Err(section.origin.at(first).bad_index(bytes.get(first).copied().unwrap_or(largest).into(), len))
}

/// 16-bit base-material indices, all less than `len`.
pub(super) fn wide_indices(section: SectionBytes<'_>, len: u32) -> Result<U16Le<'_>, ReadError> {
    numbers(section, len, u32::from)
}

/// Palette codes, all of whose pairs are among `len`.
pub(super) fn codes(section: SectionBytes<'_>, len: usize) -> Result<U16Le<'_>, ReadError> {
    let len = u32::try_from(len).unwrap_or(u32::MAX);
    numbers(section, len, |code| split_code(code).0.into())
}

/// 16-bit values whose `number` is less than `len`.
fn numbers(section: SectionBytes<'_>, len: u32, number: impl Fn(u16) -> u32) -> Result<U16Le<'_>, ReadError> {
    let values = U16Le::new(section.bytes);
    match values.iter().position(|value| number(value) >= len) {
        None => Ok(values),
        Some(at) => Err(section.origin.at_item(at, size_of::<u16>()).bad_index(values.get(at).map_or(0, number), len)),
    }
}
