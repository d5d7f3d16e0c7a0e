//! Slices of a file, and views of them as little-endian numbers of any alignment.

use half::f16;

/// `bytes[offset .. offset + length]` for numbers that came from a file; `None` where they lead outside.
pub(crate) fn slice_at(bytes: &[u8], offset: u64, length: u64) -> Option<&[u8]> {
    let start = usize::try_from(offset).ok()?;
    let end = usize::try_from(offset.checked_add(length)?).ok()?;
    bytes.get(start..end)
}

/// A borrowed run of little-endian `f32` values of any alignment.
#[derive(Clone, Copy, Debug)]
pub struct F32Le<'a>(&'a [[u8; 4]]);

impl<'a> F32Le<'a> {
    /// Views `bytes` as `f32`s; up to three bytes left over at the end are not part of the view.
    #[must_use]
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes.as_chunks().0)
    }

    /// Number of values.
    #[must_use]
    pub fn len(self) -> usize {
        self.0.len()
    }

    /// Whether there are no values.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0.is_empty()
    }

    /// Value number `index`.
    #[must_use]
    pub fn get(self, index: usize) -> Option<f32> {
        self.0.get(index).copied().map(f32::from_le_bytes)
    }

    /// All values in order.
    pub fn iter(self) -> impl Iterator<Item = f32> + 'a {
        self.0.iter().copied().map(f32::from_le_bytes)
    }

    /// The values as they stand in the file, ready for a texture upload.
    #[must_use]
    pub fn as_bytes(self) -> &'a [u8] {
        self.0.as_flattened()
    }

    /// The values' bit patterns as signed integers, which compare branch-free.
    pub(crate) fn bits(self) -> impl Iterator<Item = i32> + 'a {
        self.0.iter().copied().map(i32::from_le_bytes)
    }

    /// Whether `outside` gives a negative number for the bits of any value.
    ///
    /// Lanes of their own and one branch at the end: the loop compiles to vector code that keeps up with memory.
    pub(crate) fn any_negative(self, outside: impl Fn(i32) -> i32) -> bool {
        const LANES: usize = 16;
        let (blocks, rest) = self.0.as_chunks::<LANES>();
        let mut any = [0; LANES];
        for block in blocks {
            for (any, value) in any.iter_mut().zip(block) {
                *any |= outside(i32::from_le_bytes(*value));
            }
        }
        let rest = rest.iter().map(|value| outside(i32::from_le_bytes(*value)));
        any.into_iter().chain(rest).fold(0, |any, value| any | value) < 0
    }

    /// Three consecutive values from `index`, zero where there are none.
    pub(crate) fn rgb_at(self, index: usize) -> [f32; 3] {
        let rgb = self.0.get(index..).and_then(<[[u8; 4]]>::first_chunk::<3>);
        rgb.map_or([0.0; 3], |rgb| rgb.map(f32::from_le_bytes))
    }
}

/// A borrowed run of little-endian `u16` values of any alignment.
#[derive(Clone, Copy, Debug)]
pub struct U16Le<'a>(&'a [[u8; 2]]);

impl<'a> U16Le<'a> {
    /// Views `bytes` as `u16`s; a byte left over at the end is not part of the view.
    #[must_use]
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes.as_chunks().0)
    }

    /// Value number `index`.
    #[must_use]
    pub fn get(self, index: usize) -> Option<u16> {
        self.0.get(index).copied().map(u16::from_le_bytes)
    }

    /// All values in order.
    pub fn iter(self) -> impl Iterator<Item = u16> + 'a {
        self.0.iter().copied().map(u16::from_le_bytes)
    }

    /// Values from number `index` on; none where there are none.
    #[cfg(feature = "transfer")]
    pub(crate) fn iter_from(self, index: usize) -> impl Iterator<Item = u16> + 'a {
        self.0.get(index..).unwrap_or(&[]).iter().copied().map(u16::from_le_bytes)
    }

    /// The values as they stand in the file, ready for a texture upload.
    #[must_use]
    pub fn as_bytes(self) -> &'a [u8] {
        self.0.as_flattened()
    }
}

/// A borrowed run of little-endian half floats of any alignment.
#[derive(Clone, Copy, Debug)]
pub struct F16Le<'a>(U16Le<'a>);

impl<'a> F16Le<'a> {
    /// Views `bytes` as half floats; a byte left over at the end is not part of the view.
    #[must_use]
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(U16Le::new(bytes))
    }

    /// Value number `index`.
    #[must_use]
    pub fn get(self, index: usize) -> Option<f32> {
        self.0.get(index).map(|bits| f16::from_bits(bits).to_f32())
    }

    /// The values as they stand in the file, ready for a texture upload.
    #[must_use]
    pub fn as_bytes(self) -> &'a [u8] {
        self.0.as_bytes()
    }

    /// The values' bit patterns.
    pub fn bits(self) -> impl Iterator<Item = u16> + 'a {
        self.0.iter()
    }

    /// Three consecutive values from `index`, zero where there are none.
    pub(crate) fn rgb_at(self, index: usize) -> [f32; 3] {
        let rgb = self.0.0.get(index..).and_then(<[[u8; 2]]>::first_chunk::<3>);
        rgb.map_or([0.0; 3], |rgb| rgb.map(|bytes| f16::from_le_bytes(bytes).to_f32()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1, −2, ½, 4, and three bytes that are left over.
    const SINGLES: [u8; 19] = [0, 0, 0x80, 0x3F, 0, 0, 0, 0xC0, 0, 0, 0, 0x3F, 0, 0, 0x80, 0x40, 9, 9, 9];

    #[test]
    fn single_precision() {
        let values = F32Le::new(&SINGLES);
        assert!(values.iter().eq([1.0, -2.0, 0.5, 4.0]), "all in order");
        assert_eq!((values.len(), values.is_empty(), F32Le::new(&[1; 3]).is_empty()), (4, false, true));
        assert_eq!([0, 1, 3, 4].map(|at| values.get(at)), [Some(1.0), Some(-2.0), Some(4.0), None]);
        assert_eq!(Some(values.as_bytes()), SINGLES.get(..16));
        assert!(values.bits().eq([0x3F80_0000, -0x4000_0000, 0x3F00_0000, 0x4080_0000]), "their bits");
        assert_eq!([0, 1, 2].map(|at| values.rgb_at(at)), [[1.0, -2.0, 0.5], [-2.0, 0.5, 4.0], [0.0; 3]]);
    }

    #[test]
    fn one_negative_among_many() {
        // Two blocks of 16 and three more, all 1.
        let ones = [1.0_f32.to_le_bytes(); 35];
        let outside = |bits: i32| bits;
        assert!(!F32Le::new(ones.as_flattened()).any_negative(outside), "none");
        for (at, other) in (0..35).flat_map(|at| [(at, -1.0_f32), (at, -0.0)]) {
            let mut values = ones;
            if let Some(value) = values.get_mut(at) {
                *value = other.to_le_bytes();
            }
            assert!(F32Le::new(values.as_flattened()).any_negative(outside), "{other:?} at {at}");
        }
        let mut two = ones;
        two.iter_mut().step_by(34).for_each(|value| *value = (-1.0_f32).to_le_bytes());
        assert!(F32Le::new(two.as_flattened()).any_negative(outside), "the first and the last");
        let zeros = [0; 140];
        assert!(!F32Le::new(&zeros).any_negative(outside), "0 is not negative");
        assert!(!F32Le::new(&[]).any_negative(outside), "nothing");
    }

    #[test]
    fn sixteen_bits() {
        let bytes = [0x00, 0x3C, 0x00, 0xC0, 0x00, 0x38, 0x00, 0x44, 9];
        let (integers, halves) = (U16Le::new(&bytes), F16Le::new(&bytes));
        let due = [0x3C00, 0xC000, 0x3800, 0x4400];
        assert!(integers.iter().eq(due) && halves.bits().eq(due), "all in order");
        assert_eq!([0, 3, 4].map(|at| integers.get(at)), [Some(0x3C00), Some(0x4400), None]);
        #[cfg(feature = "transfer")]
        assert!(
            integers.iter_from(2).eq([0x3800, 0x4400]) && integers.iter_from(5).next().is_none(),
            "from the third on"
        );
        assert_eq!([0, 1, 3, 4].map(|at| halves.get(at)), [Some(1.0), Some(-2.0), Some(4.0), None]);
        assert_eq!([0, 1, 2].map(|at| halves.rgb_at(at)), [[1.0, -2.0, 0.5], [-2.0, 0.5, 4.0], [0.0; 3]]);
        assert_eq!((Some(integers.as_bytes()), Some(halves.as_bytes())), (bytes.get(..8), bytes.get(..8)));
    }

    #[test]
    fn slices_of_a_file() {
        let bytes = [1, 2, 3];
        assert_eq!(slice_at(&bytes, 1, 2), Some(&[2, 3][..]));
        assert_eq!(slice_at(&bytes, 3, 0), Some(&[][..]));
        for (offset, length) in [(1, 3), (4, 0), (u64::MAX, 1), (1, u64::MAX)] {
            assert_eq!(slice_at(&bytes, offset, length), None, "{offset}, {length}");
        }
    }
}
