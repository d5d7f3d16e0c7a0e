//! Shortest decimals of `f32`, as `{}` writes them: `core`'s own writer is a fifth of a library that reads files, and a linker
//! sees panics in it.

use core::fmt::{self, Write};

/// Number to be written with as few digits as lead back to it, and no exponent.
pub(crate) struct Decimal(pub(crate) f32);

/// Most digits that a single-precision number needs.
const MOST_DIGITS: i32 = 9;

/// 10^`exponent`.
fn ten_to(exponent: i32) -> f64 {
    let power = (0..exponent.unsigned_abs()).fold(1.0, |power, _| power * 10.0);
    if exponent < 0 { 1.0 / power } else { power }
}

/// Power of ten of the first digit, digits as an integer, and their number. `x` is finite and above 0.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "at most 10^9, and the nearest f32 is wanted"
)]
fn digits(x: f32) -> (i32, u32, i32) {
    let wide = f64::from(x);
    // Of 2^-149 to 2^128.
    let first = (-46_i32..39).rev().find(|&exponent| ten_to(exponent) <= wide).unwrap_or(0);
    let rounded = |count: i32| {
        let scale = count.wrapping_sub(1).wrapping_sub(first);
        // Powers of ten are exact up to 10^22: multiplied or divided by, not inverted.
        let (up, down) = (ten_to(scale.max(0)), ten_to(scale.wrapping_neg().max(0)));
        let number = (wide * up / down + 0.5) as u32;
        (number, (f64::from(number) * down / up) as f32)
    };
    let count = (1..MOST_DIGITS).find(|&count| rounded(count).1.to_bits() == x.to_bits()).unwrap_or(MOST_DIGITS);
    let (number, _) = rounded(count);
    // 9.9… may have become 10.
    let is_next = 10_u32.checked_pow(count.unsigned_abs()) == Some(number);
    if is_next { (first.wrapping_add(1), 1, 1) } else { (first, number, count) }
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(x) = *self;
        if x.is_nan() {
            return f.write_str("NaN");
        }
        if x.is_sign_negative() {
            f.write_char('-')?;
        }
        let x = x.abs();
        if x.is_infinite() {
            return f.write_str("inf");
        }
        if x <= 0.0 {
            return f.write_char('0');
        }
        let (first, number, count) = digits(x);
        // From the first digit, or the 0 before the point, to the last digit, or the one before the point.
        let last = first.wrapping_sub(count).wrapping_add(1);
        for place in (last.min(0)..=first.max(0)).rev() {
            if place == -1 {
                f.write_char('.')?;
            }
            let shift = place.wrapping_sub(last).unsigned_abs();
            let power = 10_u32.checked_pow(shift).filter(|_| place >= last);
            let digit = power.and_then(|power| number.checked_div(power)).unwrap_or(0).checked_rem(10).unwrap_or(0);
            f.write_char(char::from_digit(digit, 10).unwrap_or('0'))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::Decimal;
    use std::format;

    #[test]
    fn numbers_are_written_as_core_writes_them() {
        let named =
            [0.0, -0.0, 1.0, 0.1, 87.0, 1e-6, 1e6, 1e15, 0.999, f32::MAX, f32::MIN_POSITIVE, f32::NAN, f32::INFINITY];
        let patterns = (0..200_000_u32).map(|k| f32::from_bits(k.wrapping_mul(2_654_435_761)));
        let few_digits = (0..10_000_u16).map(|k| f32::from(k) / 1000.0);
        for x in named.into_iter().chain(patterns).chain(few_digits) {
            assert_eq!(format!("{}", Decimal(x)), format!("{x}"), "{x:e}");
        }
    }
}
