//! One chain of codebooks: texel → P6 → P4 (φ_v) → P3 (θ_v) → P2 (α) → P1 (β).

use crate::bits::{Items, field, mask};
use crate::btf::layout::{MEANS_PER_OCTAVE, STEPS_PER_OCTAVE, Scales};

/// Bits of the f32 values 2^(k/64).
static MANTISSAS: [u32; STEPS_PER_OCTAVE as usize] = mantissas();

#[allow(clippy::cast_possible_truncation, reason = "from 1 to 2")]
#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects, reason = "evaluated by the compiler")]
const fn mantissas() -> [u32; STEPS_PER_OCTAVE as usize] {
    let mut table = [0; STEPS_PER_OCTAVE as usize];
    let (mut power, mut k) = (1.0_f64, 0);
    while k < table.len() {
        table[k] = (power as f32).to_bits();
        // 2^(1/64)
        power *= 1.010_889_286_051_700_5;
        k += 1;
    }
    table
}

/// A scale: exponent in 1/64 octaves, and the sign in the highest bit.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Scale {
    exponent: i32,
    sign: u32,
}

impl Scale {
    /// The product of two.
    #[inline]
    pub(super) fn times(self, other: Self) -> Self {
        Self { exponent: self.exponent.wrapping_add(other.exponent), sign: self.sign ^ other.sign }
    }

    /// ±2^(exponent / 64). Products of four scales of a checked file are within ±2^96, and normal.
    #[inline]
    pub(super) fn value(self) -> f32 {
        let mantissa = MANTISSAS.get((self.exponent & 63) as usize).copied().unwrap_or(0);
        let octaves = (self.exponent >> 6).wrapping_shl(23).cast_unsigned();
        f32::from_bits(mantissa.wrapping_add(octaves) ^ self.sign)
    }

    /// For [`near`].
    #[inline]
    pub(super) fn near_bits(self) -> u32 {
        self.exponent.wrapping_shl(NEAR).cast_unsigned()
    }
}

/// Bits of an f32 below an exponent in 1/64 octaves.
const NEAR: u32 = f32::MANTISSA_DIGITS - 1 - 6;

/// What lies on straight lines between powers of two: 2^(exponent / 64), up to 6.2 % more. Exponents have been shifted to
/// where f32 have them, and added up.
#[inline]
pub(super) fn near(bits: u32) -> f32 {
    f32::from_bits(bits.wrapping_add(1.0_f32.to_bits()))
}

/// A table of items that point into the next table with a scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Table<'a> {
    items: Items<'a>,
    index_bits: u32,
    index_mask: u32,
    /// Of the code of a scale without its sign.
    code_mask: u32,
    /// 2^step
    factor: i32,
    offset: i32,
    /// Where the sign of a scale is, and 1 if there is one.
    sign_at: u32,
    sign_mask: u32,
    /// Bit above index and code.
    end: u32,
    /// The code of a scale without its sign, where it stands, and how far it is from there to where [`near`] has it.
    code_in_place: u32,
    to_near: u32,
}

impl<'a> Table<'a> {
    /// Items of an index, the code of a scale, and perhaps more above them.
    pub(super) fn new(items: Items<'a>, index_bits: u32, scales: Scales, is_signed: bool) -> Self {
        let sign = u32::from(is_signed && scales.bits > 0);
        let end = index_bits.wrapping_add(scales.bits.into());
        let code_mask = mask(u32::from(scales.bits).wrapping_sub(sign));
        Self {
            items,
            index_bits,
            index_mask: mask(index_bits),
            code_mask,
            factor: 1_i32.wrapping_shl(scales.step.into()),
            offset: scales.offset.into(),
            sign_at: end.wrapping_sub(sign),
            sign_mask: sign,
            end,
            code_in_place: code_mask.wrapping_shl(index_bits),
            to_near: NEAR.wrapping_add(scales.step.into()).wrapping_sub(index_bits),
        }
    }

    /// Index and scale in the lowest bits. The caller knows whether the stage has signs.
    #[inline]
    fn split<const SIGNED: bool>(&self, bits: u64) -> (u32, Scale) {
        let index = field(bits, 0, self.index_mask);
        let code = field(bits, self.index_bits, self.code_mask).cast_signed();
        let exponent = code.wrapping_mul(self.factor).wrapping_add(self.offset);
        let sign = if SIGNED { field(bits, self.sign_at, self.sign_mask).wrapping_shl(31) } else { 0 };
        (index, Scale { exponent, sign })
    }

    /// Bits before item `node` of a row.
    #[inline]
    pub(super) fn before(&self, node: u32) -> usize {
        self.items.before(node)
    }

    /// The item at an offset of a row.
    #[inline]
    pub(super) fn one<const SIGNED: bool>(&self, row: u32, offset: usize) -> (u32, Scale) {
        self.split::<SIGNED>(self.items.bits(row, offset))
    }

    /// The only item of a row, and what stands above its index and scale, under a mask.
    #[inline]
    pub(super) fn one_and_rest(&self, row: u32, mask: u32) -> (u32, Scale, u32) {
        let bits = self.items.bits(row, 0);
        let (index, scale) = self.split::<false>(bits);
        (index, scale, field(bits, self.end, mask))
    }

    /// The item at an offset of a row, and the next.
    #[inline]
    pub(super) fn two<const SIGNED: bool>(&self, row: u32, offset: usize) -> [(u32, Scale); 2] {
        let bits = self.items.bits(row, offset);
        let (low, high) = (self.split::<SIGNED>(bits), self.split::<SIGNED>(bits.wrapping_shr(self.items.width())));
        [low, high]
    }

    /// [`Self::two`] of a table without signs, with scales for [`near`].
    #[inline]
    pub(super) fn two_near(&self, row: u32, offset: usize) -> [(u32, u32); 2] {
        let split = |bits: u64| {
            // Rotated, because it may be to the left or to the right.
            let code = field(bits, 0, self.code_in_place).rotate_left(self.to_near);
            (field(bits, 0, self.index_mask), code.wrapping_add(self.offset.wrapping_shl(NEAR).cast_unsigned()))
        };
        let bits = self.items.bits(row, offset);
        let (low, high) = (split(bits), split(bits.wrapping_shr(self.items.width())));
        [low, high]
    }
}

/// A chain of codebooks, whose indices were checked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stage<'a> {
    /// P6, an item for every texel.
    pub(super) texels: Table<'a>,
    /// P4, rows of n_φ items.
    pub(super) p4: Table<'a>,
    /// P3, rows of n_θ items.
    pub(super) p3: Table<'a>,
    /// P2, rows of n_α items.
    pub(super) p2: Table<'a>,
    /// P1, rows of n_β values; more bytes follow.
    pub(super) p1: &'a [u8],
    /// Logarithms of the means of these rows.
    pub(super) means: &'a [u8],
    pub(super) n_beta: u8,
    /// Whether values of P1 and scales have signs.
    pub(super) is_signed: bool,
}

impl Stage<'_> {
    /// Codes of nodes `at` and `at` + 1 of a slice.
    #[inline]
    pub(super) fn slice_pair(&self, slice: u32, at: u32) -> [u8; 2] {
        let start = (slice as usize).wrapping_mul(self.n_beta.into()).wrapping_add(at as usize);
        match self.p1.get(start..start.wrapping_add(2)) {
            Some([low, high]) => [*low, *high],
            _ => [0; 2],
        }
    }

    /// The mean of a slice for [`near`], to be subtracted.
    #[inline]
    pub(super) fn mean_bits(&self, slice: u32) -> u32 {
        const SHIFT: u32 = NEAR + (STEPS_PER_OCTAVE / MEANS_PER_OCTAVE).ilog2();
        match self.means.get(slice as usize) {
            Some(code) => u32::from(*code).wrapping_shl(SHIFT),
            None => 0,
        }
    }

    /// Codes of nodes `at` to `at` + 3 of a slice; from n_β on they are others.
    #[inline]
    pub(super) fn slice_part(&self, slice: u32, at: u32) -> [u8; 4] {
        let start = (slice as usize).wrapping_mul(self.n_beta.into()).wrapping_add(at as usize);
        match self.p1.get(start..start.wrapping_add(4)).and_then(<[u8]>::first_chunk::<4>) {
            Some(part) => *part,
            None => [0; 4],
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic fails the test")]
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

    #[test]
    fn items_are_split() {
        let scales = Scales { bits: 5, step: 3, offset: -64 };
        // Index 0b101, scale 0b1_0110 and 0b10 above them; then the next item.
        let bytes = [0b1011_0101, 0b0001_1010, 0, 0, 0, 0, 0, 0, 0, 0];
        let table = |is_signed| Table::new(Items::new(&bytes, 10, 2), 3, scales, is_signed);
        let [(index, scale), (next, _)] = table(false).two::<false>(0, 0);
        assert_eq!((index, scale.exponent, scale.sign, next), (5, (0b10110 << 3) - 64, 0, 6));
        let [(index, bits), _] = table(false).two_near(0, 0);
        assert_eq!((index, bits), (5, scale.near_bits()));
        let (_, scale) = table(true).one::<true>(0, 0);
        assert_eq!((scale.exponent, scale.sign), ((0b0110 << 3) - 64, 1 << 31));
        let (_, _, rest) = table(false).one_and_rest(0, 3);
        assert_eq!(rest, 0b10);
        let none = Table::new(Items::new(&bytes, 3, 1), 3, Scales::default(), true);
        let (_, scale) = none.one::<true>(0, 0);
        assert_eq!((scale.exponent, scale.sign), (0, 0), "no bits, no sign");
    }
}
