//! Tables of items that are a few bits wide, packed without gaps.

/// Bytes that follow the last item of a table, so that every item can be read by one 64-bit load.
pub const PADDING_BYTES: usize = 8;
/// Widest item: two neighbours fit into 64 bits wherever they begin.
pub const MAX_ITEM_BITS: u32 = 28;

/// Rows of items of up to [`MAX_ITEM_BITS`] bits; the first begins at the lowest bit of the first byte.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Items<'a> {
    bytes: &'a [u8],
    width: u32,
    row_bits: u32,
    mask: u32,
}

/// Bytes of `count` items of `width` bits, padding included; `None` if there is no such number.
pub(crate) fn packed_bytes(count: u64, width: u32) -> Option<u64> {
    count.checked_mul(u64::from(width))?.div_ceil(8).checked_add(PADDING_BYTES as u64)
}

/// Bits that tell `count` things apart.
#[must_use]
pub const fn index_bits(count: u32) -> u32 {
    u32::BITS.wrapping_sub(count.saturating_sub(1).leading_zeros())
}

/// The lowest `width` bits set, of at most 31.
pub(crate) const fn mask(width: u32) -> u32 {
    1_u32.wrapping_shl(width).wrapping_sub(1)
}

/// Bits `at` to 31 + `at`, `at` less than 64, under a mask.
#[inline]
pub(crate) fn field(bits: u64, at: u32, mask: u32) -> u32 {
    #[allow(clippy::cast_possible_truncation, reason = "a mask has 32 bits")]
    let low = bits.wrapping_shr(at) as u32;
    low & mask
}

impl<'a> Items<'a> {
    /// Rows of `nodes` items of `width` bits.
    pub(crate) fn new(bytes: &'a [u8], width: u32, nodes: u8) -> Self {
        Self { bytes, width, row_bits: width.wrapping_mul(nodes.into()), mask: mask(width) }
    }

    /// Bits before item `node` of a row.
    #[inline]
    pub(crate) fn before(&self, node: u32) -> usize {
        node.wrapping_mul(self.width) as usize
    }

    /// At least 57 bits from bit `offset` of a row: an item that begins there and, above it, the next.
    #[inline]
    pub(crate) fn bits(&self, row: u32, offset: usize) -> u64 {
        let bit = (row as usize).wrapping_mul(self.row_bits as usize).wrapping_add(offset);
        let start = bit >> 3;
        // One comparison: what was shifted down cannot wrap.
        match self.bytes.get(start..start.wrapping_add(PADDING_BYTES)).and_then(<[u8]>::first_chunk::<8>) {
            Some(bytes) => u64::from_le_bytes(*bytes) >> (bit & 7),
            None => 0,
        }
    }

    /// The item at an offset of a row, and the next.
    #[inline]
    pub(crate) fn two(&self, row: u32, offset: usize) -> [u32; 2] {
        let bits = self.bits(row, offset);
        [field(bits, 0, self.mask), field(bits, self.width, self.mask)]
    }

    /// Bits of an item.
    #[inline]
    pub(crate) fn width(&self) -> u32 {
        self.width
    }
}

#[cfg(test)]
#[allow(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_truncation,
    clippy::indexing_slicing,
    reason = "a panic fails the test"
)]
mod tests {
    use super::*;

    #[test]
    fn items_are_where_they_were_put() {
        for width in 1..=MAX_ITEM_BITS {
            let value = |k: usize| field((k as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15), 20, mask(width));
            let mut bytes = [0_u8; 256];
            for k in 0..40 {
                for bit in 0..width {
                    let at = k * width as usize + bit as usize;
                    bytes[at / 8] |= ((value(k) >> bit & 1) as u8) << (at % 8);
                }
            }
            let items = Items::new(&bytes, width, 5);
            for k in 0..39 {
                let found = items.two(k as u32 / 5, items.before(k as u32 % 5));
                assert_eq!(found, [value(k), value(k + 1)], "item {k} of {width} bits and its neighbour");
            }
            assert_eq!(items.bits(1 << 20, 0), 0, "there is none");
        }
    }

    #[test]
    fn bits_tell_things_apart() {
        for (count, bits) in [(0, 0), (1, 0), (2, 1), (3, 2), (256, 8), (257, 9), (u32::MAX, 32)] {
            assert_eq!(index_bits(count), bits, "{count}");
        }
        assert_eq!(packed_bytes(3, 5), Some(10));
        assert_eq!(packed_bytes(u64::MAX, 2), None);
    }
}
