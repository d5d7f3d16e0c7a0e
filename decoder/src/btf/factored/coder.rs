//! Adaptive binary arithmetic coding: a range decoder, and what an encoder has to agree with.
//!
//! A code is a number in a range; every bit takes the lower part of the range where it is 0 and the upper part where
//! it is 1, in the ratio of its probabilities (Martin 1979). A range below 2²⁴ is made 256 times as wide by the next byte.

/// Adaptive probability that a bit is 0, learnt from the bits before it: the mean of a fast and a slow estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitModel {
    fast: u16,
    slow: u16,
}

/// Binary logarithm of how slowly the fast estimate follows: a bit moves it by 2⁻⁴ of the way.
const FAST: u32 = 4;
/// The same of the slow estimate: 2⁻⁷.
const SLOW: u32 = 7;

impl BitModel {
    /// Probability ½: nothing is known yet.
    pub const EVEN: Self = Self { fast: 1 << 15, slow: 1 << 15 };

    /// Probability in 1/65,536: 71 to 65,464, so that neither bit is ever impossible.
    #[must_use]
    #[inline]
    pub fn of_zero(self) -> u32 {
        u32::from(self.fast).wrapping_add(self.slow.into()) >> 1
    }

    /// Moves both estimates towards a bit.
    #[inline]
    pub fn update(&mut self, bit: bool) {
        let moved = |estimate: u16, shift: u32| {
            let towards_zero = estimate.wrapping_add(u16::MAX.wrapping_sub(estimate).wrapping_shr(shift));
            if bit { estimate.wrapping_sub(estimate.wrapping_shr(shift)) } else { towards_zero }
        };
        *self = Self { fast: moved(self.fast, FAST), slow: moved(self.slow, SLOW) };
    }
}

/// Range below which a byte is shifted in or out.
pub const LEAST_RANGE: u32 = 1 << 24;

/// Part of a range that stands for 0.
#[must_use]
#[inline]
pub fn part_of_zero(range: u32, model: BitModel) -> u32 {
    (range >> 16).wrapping_mul(model.of_zero())
}

/// Reader or writer of bits: models of what is coded are the same for both.
pub trait BitCoder {
    /// One bit. Writers write `bit` and return it; readers return what they read.
    fn bit(&mut self, model: &mut BitModel, bit: bool) -> bool;
    /// One bit of probability ½, which is not learnt.
    fn even(&mut self, bit: bool) -> bool;
}

/// Reader of bits. Beyond its end a code goes on with zeros: any bytes are some sequence of bits.
#[derive(Clone, Debug)]
pub struct RangeDecoder<'a> {
    bytes: &'a [u8],
    range: u32,
    code: u32,
}

impl<'a> RangeDecoder<'a> {
    /// Reader at the start of a code.
    #[must_use]
    pub fn new(bytes: &'a [u8]) -> Self {
        let mut decoder = Self { bytes, range: u32::MAX, code: 0 };
        for _ in 0..4 {
            decoder.shift();
        }
        decoder.range = u32::MAX;
        decoder
    }

    #[inline]
    fn shift(&mut self) {
        let (next, rest) = self.bytes.split_first().unwrap_or((&0, &[]));
        self.code = (self.code << 8) | u32::from(*next);
        self.range <<= 8;
        self.bytes = rest;
    }

    /// Takes the lower part of the range, or what is above it.
    #[inline]
    fn take(&mut self, lower: u32) -> bool {
        let bit = self.code >= lower;
        if bit {
            self.code = self.code.wrapping_sub(lower);
            self.range = self.range.wrapping_sub(lower);
        } else {
            self.range = lower;
        }
        // Neither part is ever empty: at most three times.
        while self.range < LEAST_RANGE {
            self.shift();
        }
        bit
    }
}

impl BitCoder for RangeDecoder<'_> {
    #[inline]
    fn bit(&mut self, model: &mut BitModel, _: bool) -> bool {
        let bit = self.take(part_of_zero(self.range, *model));
        model.update(bit);
        bit
    }

    #[inline]
    fn even(&mut self, _: bool) -> bool {
        self.take(self.range >> 1)
    }
}
