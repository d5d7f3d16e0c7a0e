//! Scales: powers of two in steps of 1/64 octaves, with a sign in some stages.

use crate::powers::POWERS;

/// Scale: exponent in 1/64 octaves, and the sign in the highest bit.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Scale {
    pub(super) exponent: i32,
    pub(super) sign: u32,
}

impl Scale {
    /// The product of two.
    #[inline]
    pub(super) fn times(self, other: Self) -> Self {
        Self { exponent: self.exponent.wrapping_add(other.exponent), sign: self.sign ^ other.sign }
    }

    /// ±2^(exponent / 64). Products of a checked file are within 2^±104, and normal.
    #[inline]
    pub(super) fn value(self) -> f32 {
        let mantissa = POWERS.get((self.exponent & 63) as usize).copied().unwrap_or(0);
        let octaves = (self.exponent >> 6).wrapping_shl(23).cast_unsigned();
        f32::from_bits(mantissa.wrapping_add(octaves) ^ self.sign)
    }

    /// Exponent where f32 have it, for [`near`].
    #[inline]
    pub(super) fn near_bits(self) -> u32 {
        self.exponent.wrapping_shl(NEAR).cast_unsigned()
    }
}

/// Bits of an f32 below an exponent in 1/64 octaves.
pub(super) const NEAR: u32 = f32::MANTISSA_DIGITS - 1 - 6;

/// Approximation by straight lines between powers of two: 2^(exponent / 64), up to 6.2 % more. Exponents have been shifted to
/// where f32 have them, and added up.
#[inline]
pub(super) fn near(bits: u32) -> f32 {
    f32::from_bits(bits.wrapping_add(1.0_f32.to_bits()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_powers_of_two() {
        for exponent in [-6144_i16, -640, -65, -64, -1, 0, 1, 63, 64, 100, 6144] {
            let expected = libm::exp2f(f32::from(exponent) / 64.0);
            for (sign, factor) in [(0, 1.0), (1 << 31, -1.0)] {
                let value = Scale { exponent: exponent.into(), sign }.value() * factor;
                assert!((value / expected - 1.0).abs() < 1e-6, "{exponent}: {value} {expected}");
            }
            let near = near(Scale { exponent: exponent.into(), sign: 0 }.near_bits()) / expected;
            assert!((0.999_999..1.062).contains(&near), "{exponent}: {near}");
        }
    }
}
