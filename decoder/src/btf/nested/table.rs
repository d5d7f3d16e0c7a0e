//! Codebooks whose items point into the next one, with a scale.

use super::layout::Scales;
use super::scale::{NEAR, Scale};
use crate::container::bits::{Items, field, mask};

/// Decoder of the codes of scales.
#[derive(Clone, Copy, Debug)]
struct Codes {
    /// Mask of a code without its sign.
    mask: u32,
    /// Bit of the sign.
    sign_at: u32,
    /// 1 if there is a sign.
    sign_mask: u32,
    /// 2^step.
    factor: i32,
    offset: i32,
}

impl Codes {
    fn new(scales: Scales, is_signed: bool) -> Self {
        let sign = u32::from(is_signed && scales.bits > 0);
        let below = u32::from(scales.bits).wrapping_sub(sign);
        let factor = 1_i32.wrapping_shl(scales.step.into());
        Self { mask: mask(below), sign_at: below, sign_mask: sign, factor, offset: scales.offset.into() }
    }

    /// The scale of the lowest bits. The caller knows whether the stage has signs.
    #[inline]
    fn scale<const SIGNED: bool>(&self, code: u32) -> Scale {
        let size = (code & self.mask).cast_signed();
        let sign = if SIGNED { (code.wrapping_shr(self.sign_at) & self.sign_mask).wrapping_shl(31) } else { 0 };
        Scale { exponent: size.wrapping_mul(self.factor).wrapping_add(self.offset), sign }
    }
}

/// P6, P4 or P3: items of an index and, above it, the code of a scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Table<'a> {
    items: Items<'a>,
    index_bits: u32,
    index_mask: u32,
    codes: Codes,
    /// Bit above index and code.
    end: u32,
}

impl<'a> Table<'a> {
    /// Items of an index, the code of a scale, and perhaps more above them.
    pub(super) fn new(items: Items<'a>, index_bits: u32, scales: Scales, is_signed: bool) -> Self {
        let end = index_bits.wrapping_add(scales.bits.into());
        Self { items, index_bits, index_mask: mask(index_bits), codes: Codes::new(scales, is_signed), end }
    }

    /// Index and scale in the lowest bits.
    #[inline]
    fn split<const SIGNED: bool>(&self, bits: u64) -> (u32, Scale) {
        let code = field(bits, self.index_bits, u32::MAX);
        (field(bits, 0, self.index_mask), self.codes.scale::<SIGNED>(code))
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
}

/// P2: codes of scales in bytes, and items of an index and those bits of codes that are above eight.
///
/// Samplers want all scales of a row, and only them.
#[derive(Clone, Copy, Debug)]
pub(super) struct SliceTable<'a> {
    bytes: &'a [u8],
    n_alpha: u8,
    items: Items<'a>,
    index_bits: u32,
    index_mask: u32,
    has_bytes_only: bool,
    codes: Codes,
}

impl<'a> SliceTable<'a> {
    /// Bytes, and more after them.
    pub(super) fn new(
        bytes: &'a [u8],
        n_alpha: u8,
        items: Items<'a>,
        index_bits: u32,
        scales: Scales,
        is_signed: bool,
    ) -> Self {
        let (has_bytes_only, codes) = (scales.bits <= 8, Codes::new(scales, is_signed));
        Self { bytes, n_alpha, items, index_bits, index_mask: mask(index_bits), has_bytes_only, codes }
    }

    /// Where the byte of a node of a row is.
    #[inline]
    fn place(&self, row: u32, node: u32) -> usize {
        row.wrapping_mul(self.n_alpha.into()).wrapping_add(node) as usize
    }

    /// Items `node` and `node` + 1 of a row.
    #[inline]
    pub(super) fn two<const SIGNED: bool>(&self, row: u32, node: u32) -> [(u32, Scale); 2] {
        let place = self.place(row, node);
        let (mut low, mut high) = match self.bytes.get(place..place.wrapping_add(2)) {
            Some([low, high]) => (u32::from(*low), u32::from(*high)),
            _ => (0, 0),
        };
        let bits = self.items.bits(row, self.items.before(node));
        let above = bits.wrapping_shr(self.items.width());
        if !self.has_bytes_only {
            let upper = |bits| field(bits, self.index_bits, u32::MAX).wrapping_shl(8);
            (low, high) = (low | upper(bits), high | upper(above));
        }
        let item = |bits, code| (field(bits, 0, self.index_mask), self.codes.scale::<SIGNED>(code));
        [item(bits, low), item(above, high)]
    }

    /// Scales of nodes `node` to `node` + 3 of a row, for [`near`](super::scale::near); from n_α on they are others.
    /// There are no signs.
    #[inline]
    pub(super) fn four_near(&self, row: u32, node: u32) -> [u32; 4] {
        if self.has_bytes_only {
            let place = self.place(row, node);
            let bytes = match self.bytes.get(place..place.wrapping_add(4)).and_then(<[u8]>::first_chunk::<4>) {
                Some(bytes) => *bytes,
                None => [0; 4],
            };
            // A factor of 2^step, but vectors are shifted faster than multiplied.
            let shift = NEAR.wrapping_add(self.codes.factor.trailing_zeros());
            let offset = self.codes.offset.cast_unsigned().wrapping_shl(NEAR);
            bytes.map(|code| (u32::from(code) & self.codes.mask).wrapping_shl(shift).wrapping_add(offset))
        } else {
            let ([(_, a), (_, b)], [(_, c), (_, d)]) =
                (self.two::<false>(row, node), self.two::<false>(row, node.wrapping_add(2)));
            [a, b, c, d].map(Scale::near_bits)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALES: Scales = Scales { bits: 5, step: 3, offset: -64 };

    #[test]
    fn items_are_split() {
        // Index 0b101, scale 0b1_0110 and 0b10 above them; then the next item.
        let bytes = [0b1011_0101, 0b0001_1010, 0, 0, 0, 0, 0, 0, 0, 0];
        let table = |is_signed| Table::new(Items::new(&bytes, 10, 2), 3, SCALES, is_signed);
        let [(index, scale), (next, _)] = table(false).two::<false>(0, 0);
        assert_eq!((index, scale.exponent, scale.sign, next), (5, (0b10110 << 3) - 64, 0, 6));
        let (_, scale) = table(true).one::<true>(0, 0);
        assert_eq!((scale.exponent, scale.sign), ((0b0110 << 3) - 64, 1 << 31));
        let (_, _, rest) = table(false).one_and_rest(0, 3);
        assert_eq!(rest, 0b10);
        let none = Table::new(Items::new(&bytes, 3, 1), 3, Scales::default(), true);
        let (_, scale) = none.one::<true>(0, 0);
        assert_eq!((scale.exponent, scale.sign), (0, 0), "no bits, no sign");
    }

    #[test]
    fn codes_stand_apart_from_indices() {
        // Two rows of five codes, and items of two bits.
        let codes = [3, 31, 0, 7, 8, 9, 10, 11, 12, 13, 0, 0, 0, 0];
        let items = [0b1110_0100, 0b1110_0100, 0b1110, 0, 0, 0, 0, 0, 0, 0, 0];
        let table = SliceTable::new(&codes, 5, Items::new(&items, 2, 5), 2, SCALES, false);
        let [(low, c_low), (high, c_high)] = table.two::<false>(0, 1);
        assert_eq!((low, high), (1, 2));
        assert_eq!((c_low.exponent, c_high.exponent), ((31 << 3) - 64, -64));
        let [(low, c_low), (high, c_high)] = table.two::<false>(1, 3);
        assert_eq!((low, high, c_low.exponent, c_high.exponent), (2, 3, (12 << 3) - 64, (13 << 3) - 64));
        let expected = [10, 11, 12, 13].map(|code| Scale { exponent: (code << 3) - 64, sign: 0 }.near_bits());
        assert_eq!(table.four_near(1, 1), expected);
        // Ten bits, the upper two of which stand where indices had been.
        let wide = Scales { bits: 10, step: 0, offset: 0 };
        let table = SliceTable::new(&codes, 5, Items::new(&items, 2, 5), 0, wide, false);
        let expected = [3, 31 | 1 << 8, 2 << 8, 7 | 3 << 8].map(|code| Scale { exponent: code, sign: 0 }.near_bits());
        assert_eq!(table.four_near(0, 0), expected);
        let [(_, scale), _] = SliceTable::new(&codes, 5, Items::new(&items, 2, 5), 0, wide, true).two::<true>(0, 3);
        assert_eq!((scale.exponent, scale.sign), (7 | 1 << 8, 1 << 31));
    }
}
