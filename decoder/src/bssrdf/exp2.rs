//! Powers of two by a table.

use crate::powers::{POWERS, STEPS};

/// 1.5 · 2²³: added to a number of less than 2²², it leaves the nearest whole number in the lowest bits.
const ROUNDING: f32 = 12_582_912.0;
/// Least exponent whose power is normal.
const LEAST: f32 = -126.0;

/// Largest whole exponent.
const MOST: f32 = 127.0;

/// 2^x with a relative error of at most 1.7 · 10⁻⁷; 0 where 2^x is not normal in f32, below −126, and 2¹²⁷ above 127 and for NaN.
///
/// x is n / 64 + f with |f| ≤ 1 / 128: 2^(n / 64) from the table, 2^f by the first three terms of its series, whose error is 2.7 · 10⁻⁸.
#[inline]
pub(super) fn exp2(x: f32) -> f32 {
    use core::f32::consts::LN_2;
    if x < LEAST {
        return 0.0;
    }
    let x = x.min(MOST);
    let rounded = x * 64.0 + ROUNDING;
    let n = rounded.to_bits().wrapping_sub(ROUNDING.to_bits()).cast_signed();
    let f = x - (rounded - ROUNDING) * (1.0 / 64.0);
    let power = POWERS.get(n as usize % STEPS).copied().unwrap_or(0);
    let power = f32::from_bits(power.wrapping_add((n >> 6).cast_unsigned().wrapping_shl(23)));
    power + power * (f * (LN_2 + f * (0.5 * LN_2 * LN_2)))
}

#[cfg(test)]
mod tests {
    use super::exp2;

    #[test]
    fn powers_are_within_the_stated_error() {
        let mut largest = 0.0_f64;
        // Steps of 1/4096 with an odd rest, so that every place between two entries of the table is met.
        for k in -126 * 4096..127 * 4096 {
            #[allow(clippy::cast_possible_truncation, reason = "the nearest f32 is the argument")]
            let x = (f64::from(k) / 4096.0 + 1e-5) as f32;
            let exact = libm::exp2(f64::from(x));
            largest = largest.max((f64::from(exp2(x)) / exact - 1.0).abs());
        }
        assert!(largest < 1.7e-7, "{largest:e}");
        assert_eq!([-127.0, -1e6, f32::NEG_INFINITY].map(exp2), [0.0; 3]);
        assert_eq!([127.5, 1e9, f32::INFINITY, f32::NAN].map(exp2), [exp2(127.0); 4]);
        assert_eq!([0.0, 1.0, -3.0, 127.0].map(exp2), [1.0, 2.0, 0.125, 1.701_411_8e38], "whole powers are exact");
        assert_eq!([-126.0, (-126.0_f32).next_down()].map(exp2), [f32::MIN_POSITIVE, 0.0], "the least power, and none");
    }
}
