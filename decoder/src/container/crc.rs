//! CRC-32 as gzip and PNG use it (`FORMAT.md`, section 1).
//!
//! Written here because the crates for it index their tables with `[]`: at `opt-level = "s"`, as firmware is built,
//! their panics stay in the binary. `u8` look-ups through `get` cannot panic at any level.

const SLICES: usize = 8;

/// Table k: the CRC of a byte followed by k zero bytes.
type Tables = [[u32; 256]; SLICES];

#[allow(
    clippy::arithmetic_side_effects,
    clippy::indexing_slicing,
    clippy::cast_possible_truncation,
    reason = "runs at compile time, where a panic is a build error"
)]
const fn tables() -> Tables {
    let mut tables = [[0; 256]; SLICES];
    let mut byte = 0;
    while byte < 256 {
        let mut crc = byte as u32;
        let mut slice = 0;
        while slice < SLICES {
            let mut bit = 0;
            while bit < 8 {
                crc = (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg());
                bit += 1;
            }
            tables[slice][byte] = crc;
            slice += 1;
        }
        byte += 1;
    }
    tables
}

static TABLES: Tables = tables();

/// CRC-32 of `bytes`.
#[must_use]
pub fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = Crc32::NEW;
    crc.update(bytes);
    crc.value()
}

/// CRC-32 of bytes that come one run after the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crc32(u32);

impl Crc32 {
    /// CRC-32 of nothing yet.
    pub(crate) const NEW: Self = Self(u32::MAX);

    /// Takes in the next bytes.
    pub(crate) fn update(&mut self, bytes: &[u8]) {
        let [t0, t1, t2, t3, t4, t5, t6, t7] = &TABLES;
        let look_up = |table: &[u32; 256], byte: u8| table.get(usize::from(byte)).copied().unwrap_or(0);
        let (blocks, rest) = bytes.as_chunks::<SLICES>();
        let Self(mut crc) = *self;
        for &[a, b, c, d, e, f, g, h] in blocks {
            let [a, b, c, d] = (crc ^ u32::from_le_bytes([a, b, c, d])).to_le_bytes();
            crc = look_up(t7, a)
                ^ look_up(t6, b)
                ^ look_up(t5, c)
                ^ look_up(t4, d)
                ^ look_up(t3, e)
                ^ look_up(t2, f)
                ^ look_up(t1, g)
                ^ look_up(t0, h);
        }
        for &byte in rest {
            let [low, ..] = crc.to_le_bytes();
            crc = (crc >> 8) ^ look_up(t0, low ^ byte);
        }
        *self = Self(crc);
    }

    /// CRC-32 of all bytes so far.
    pub(crate) fn value(self) -> u32 {
        !self.0
    }
}
