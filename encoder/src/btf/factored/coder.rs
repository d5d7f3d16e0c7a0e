//! Range coder, the writing side of the decoder's.

use subsurf_decoder::btf::factored::coder::{BitCoder, BitModel, LEAST_RANGE, part_of_zero};

/// Range coder: bits to bytes, by the chances that a model gives them.
pub(super) struct Encoder {
    bytes: Vec<u8>,
    /// Lower end of the range; bit 32 is a carry.
    low: u64,
    range: u32,
}

impl Encoder {
    pub(super) fn new() -> Self {
        Self { bytes: Vec::new(), low: 0, range: u32::MAX }
    }

    /// Moves a carry into the bytes that are out, and the highest byte after them.
    fn shift(&mut self) {
        self.carry();
        self.bytes.push(self.low.to_le_bytes()[3]);
        self.low = (self.low & 0x00FF_FFFF) << 8;
        self.range <<= 8;
    }

    fn carry(&mut self) {
        if self.low >> 32 == 1 {
            self.low &= u64::from(u32::MAX);
            for byte in self.bytes.iter_mut().rev() {
                *byte = byte.wrapping_add(1);
                if *byte != 0 {
                    break;
                }
            }
        }
    }

    fn put(&mut self, lower: u32, bit: bool) -> bool {
        if bit {
            self.low += u64::from(lower);
            self.range -= lower;
        } else {
            self.range = lower;
        }
        while self.range < LEAST_RANGE {
            self.shift();
        }
        bit
    }

    /// All that was written; readers take zeros for what is not there.
    pub(super) fn finish(mut self) -> Vec<u8> {
        // The number in the range that has most zeros at its end.
        let low = self.low;
        for bits in (0..32).rev() {
            let rounded = (low + (1 << bits) - 1) >> bits << bits;
            if rounded < low + u64::from(self.range) {
                self.low = rounded;
                break;
            }
        }
        for _ in 0..4 {
            self.shift();
        }
        while self.bytes.last() == Some(&0) {
            self.bytes.pop();
        }
        self.bytes
    }
}

impl BitCoder for Encoder {
    fn bit(&mut self, chance: &mut BitModel, bit: bool) -> bool {
        self.put(part_of_zero(self.range, *chance), bit);
        chance.update(bit);
        bit
    }

    fn even(&mut self, bit: bool) -> bool {
        self.put(self.range >> 1, bit)
    }
}

#[cfg(test)]
#[allow(clippy::cast_possible_truncation, reason = "small numbers")]
mod tests {
    use super::*;
    use crate::synthetic::unit;
    use subsurf_decoder::btf::factored::coder::RangeDecoder;
    use subsurf_decoder::btf::factored::model::IntegerModel;

    /// Carries run through many bytes when likely bits are followed by unlikely ones.
    #[test]
    fn bits_come_back() {
        for seed in 0..40_u32 {
            let bit =
                |k: u32| unit(seed * 10_000 + k) < [0.5, 0.999, 0.001, 0.1][(k as usize / 700 + seed as usize) % 4];
            let mut encoder = Encoder::new();
            let mut chance = BitModel::EVEN;
            for k in 0..4_000 {
                if k % 7 == 0 {
                    encoder.even(bit(k))
                } else {
                    encoder.bit(&mut chance, bit(k))
                };
            }
            let bytes = encoder.finish();
            let (mut decoder, mut chance) = (RangeDecoder::new(&bytes), BitModel::EVEN);
            for k in 0..4_000 {
                let found = if k % 7 == 0 { decoder.even(false) } else { decoder.bit(&mut chance, false) };
                assert_eq!(found, bit(k), "bit {k} of {seed}");
            }
        }
    }

    #[test]
    fn numbers_of_all_sizes_come_back_whatever_is_expected() {
        let numbers: Vec<i32> =
            (0..3_000).map(|k| ((unit(k) - 0.5) * 2.0_f32.powf(16.0 * unit(k + 9_999))) as i32).collect();
        let expected = |k: usize| [0.0, 0.4, 3.0, 200.0, 1e9][k % 5];
        let mut encoder = Encoder::new();
        let mut model = IntegerModel::default();
        for (k, number) in numbers.iter().enumerate() {
            model.code(&mut encoder, expected(k), *number);
        }
        let bytes = encoder.finish();
        let (mut decoder, mut model) = (RangeDecoder::new(&bytes), IntegerModel::default());
        for (k, number) in numbers.iter().enumerate() {
            assert_eq!(model.code(&mut decoder, expected(k), 0), *number, "number {k}");
        }
    }

    #[test]
    fn what_is_expected_costs_little() {
        let mut encoder = Encoder::new();
        let mut chance = BitModel::EVEN;
        for _ in 0..10_000 {
            encoder.bit(&mut chance, false);
        }
        let bytes = encoder.finish().len();
        assert!(bytes < 40, "{bytes} bytes for 10,000 equal bits");
    }
}
