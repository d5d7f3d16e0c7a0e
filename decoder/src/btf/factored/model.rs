//! Models of entropy-coded integers, the same for readers and writers: how integers are bits, and which are expected.

use super::coder::{BitCoder, BitModel};

/// Largest magnitude of a number.
pub const MAX_NUMBER: i32 = 32_767;
/// Classes of expected magnitudes: half octaves from 2⁻⁵.
const CLASSES: usize = 24;
/// Bits of the unary part of a number that have a model of their own.
const STEPS: usize = 12;
/// Longest unary part.
const LONGEST: u32 = 20;

/// Models of the bits of signed integers, by the magnitude that is expected.
#[derive(Clone, Debug)]
pub struct IntegerModel {
    /// Whether a number is 0.
    is_not_zero: [BitModel; CLASSES],
    /// Whether the unary part goes on.
    is_more: [[BitModel; STEPS]; CLASSES],
    /// Highest bit of the binary part.
    high: [BitModel; CLASSES],
}

impl Default for IntegerModel {
    fn default() -> Self {
        Self {
            is_not_zero: [BitModel::EVEN; CLASSES],
            is_more: [[BitModel::EVEN; STEPS]; CLASSES],
            high: [BitModel::EVEN; CLASSES],
        }
    }
}

/// Class of an expected magnitude, and bits of the binary part of numbers of this class.
fn class(expected: f32) -> (usize, u32) {
    // Exponent and highest bit of the fraction count half octaves.
    const FIRST: u32 = (127 - 5) << 1;
    const LAST: u32 = 23;
    let half_octaves = (expected.max(0.0).to_bits() >> 22).saturating_sub(FIRST).min(LAST);
    (half_octaves as usize, half_octaves.saturating_sub(12) >> 1)
}

impl IntegerModel {
    /// One number, −32,767 to 32,767, whose magnitude is expected to be `expected`.
    ///
    /// Whether it is 0, its sign, and its magnitude less 1 by a Golomb-Rice code (Rice and Plaunt 1971).
    #[inline]
    pub fn code<C: BitCoder>(&mut self, coder: &mut C, expected: f32, number: i32) -> i32 {
        let (class, bits) = class(expected);
        let (Some(is_not_zero), Some(is_more), Some(high)) =
            (self.is_not_zero.get_mut(class), self.is_more.get_mut(class), self.high.get_mut(class))
        else {
            return 0;
        };
        if !coder.bit(is_not_zero, number != 0) {
            return 0;
        }
        let is_negative = coder.even(number < 0);
        let above_one = number.unsigned_abs().wrapping_sub(1);
        let goal = above_one.wrapping_shr(bits);
        let mut unary = 0_u32;
        let [first @ .., last] = is_more;
        while unary < LONGEST {
            let model = first.get_mut(unary as usize).unwrap_or(last);
            if !coder.bit(model, goal > unary) {
                break;
            }
            unary = unary.wrapping_add(1);
        }
        if unary == LONGEST {
            unary = unary.wrapping_add(exponential(coder, goal.wrapping_sub(LONGEST)));
        }
        let mut magnitude = unary;
        for bit in (0..bits).rev() {
            let set = above_one.wrapping_shr(bit) & 1 == 1;
            let set = if bit.wrapping_add(1) == bits { coder.bit(high, set) } else { coder.even(set) };
            magnitude = (magnitude << 1) | u32::from(set);
        }
        let magnitude = magnitude.wrapping_add(1).min(MAX_NUMBER.unsigned_abs()).cast_signed();
        if is_negative { magnitude.wrapping_neg() } else { magnitude }
    }
}

/// Exponential Golomb code of bits of probability ½; below 2¹⁶.
fn exponential<C: BitCoder>(coder: &mut C, number: u32) -> u32 {
    let length = number.wrapping_add(1).checked_ilog2().unwrap_or(0);
    let mut bits = 0_u32;
    while bits < 15 && coder.even(length > bits) {
        bits = bits.wrapping_add(1);
    }
    let mut value = 1_u32;
    for bit in (0..bits).rev() {
        value = (value << 1) | u32::from(coder.even(number.wrapping_add(1).wrapping_shr(bit) & 1 == 1));
    }
    value.wrapping_sub(1)
}

/// Expected magnitude in the core of a component at a view axis and a light axis.
///
/// From what the components before it had there (`usual`), and from this component's magnitudes on the axes before:
/// one and two light axes back, and on the view axis before, here and one light axis on.
#[must_use]
#[inline]
pub fn expected_core(usual: f32, before: [f32; 2], above: [f32; 2]) -> f32 {
    let ([left, second], [up, right]) = (before, above);
    0.5 * usual + 0.25 * (0.6 * (left + up) + 0.4 * (second + right))
}

/// Running mean of magnitudes after one more of them.
#[must_use]
#[inline]
pub fn usual_core(usual: f32, magnitude: f32) -> f32 {
    usual + 0.3 * (magnitude - usual)
}

/// Codes the core of one component, `[view axis][light axis]`, `light_axes` to a row; `usual` goes on from component to
/// component and begins with zeros. Numbers are whole.
pub fn code_core<C: BitCoder>(
    coder: &mut C,
    numbers: &mut IntegerModel,
    light_axes: usize,
    core: &mut [f32],
    usual: &mut [f32],
) {
    let mut at = 0_usize;
    let rows = core.len().checked_div(light_axes).unwrap_or(0);
    for row in 0..rows {
        let (mut left, mut second) = (0.0, 0.0);
        for column in 0..light_axes {
            let above = |step: usize| {
                let inside = row > 0 && column.wrapping_add(step) < light_axes;
                let place = at.wrapping_sub(light_axes).wrapping_add(step);
                if inside { core.get(place).map_or(0.0, |number: &f32| number.abs()) } else { 0.0 }
            };
            let above = [above(0), above(1)];
            if let (Some(number), Some(usual)) = (core.get_mut(at), usual.get_mut(at)) {
                let expected = expected_core(*usual, [left, second], above);
                #[allow(clippy::cast_possible_truncation, reason = "whole, at most 32,767")]
                let whole = *number as i32;
                #[allow(clippy::cast_precision_loss, reason = "at most 32,767")]
                let coded = numbers.code(coder, expected, whole) as f32;
                *number = coded;
                *usual = usual_core(*usual, coded.abs());
                (second, left) = (left, coded.abs());
            }
            at = at.wrapping_add(1);
        }
    }
}

/// Codes the codewords of one stage, rows of `width` numbers, at most 255. A magnitude is expected to be what the
/// codewords before had in its place.
pub fn code_words<C: BitCoder>(coder: &mut C, width: usize, words: &mut [i16]) {
    let mut numbers = IntegerModel::default();
    let mut usual = [0.0_f32; 255];
    for word in words.chunks_exact_mut(width.max(1)) {
        for (number, usual) in word.iter_mut().zip(&mut usual) {
            let coded = numbers.code(coder, *usual, (*number).into());
            *number = i16::try_from(coded).unwrap_or(i16::MAX);
            #[allow(clippy::cast_precision_loss, reason = "at most 32,767")]
            let magnitude = coded.abs() as f32;
            *usual += 0.1 * (magnitude - *usual);
        }
    }
}
