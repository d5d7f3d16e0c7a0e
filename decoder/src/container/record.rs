//! Records: little-endian fields that follow each other without gaps. One list of fields both reads and writes a record.
//!
//! `bytemuck::Pod` would be the usual way to cast such records. It cannot be derived here: the derive writes
//! `unsafe impl Pod`, and this crate forbids unsafe code. A packed struct whose fields are copied one by one has the same
//! size and offsets: `size_of` and `offset_of!` of it are those of the file, and errors name offsets with them.

/// A value that can be a field of a record.
pub(crate) trait Field: Sized {
    /// The value of the first bytes, which are taken off. Zeros stand for bytes that are missing.
    fn take(bytes: &mut &[u8]) -> Self;

    /// Writes the value to the next bytes of a record.
    fn put<'o>(self, out: &mut impl Iterator<Item = &'o mut u8>);

    /// The value at the start of `bytes`; zeros stand for bytes that are missing.
    #[inline]
    fn from_bytes(mut bytes: &[u8]) -> Self {
        Self::take(&mut bytes)
    }

    /// The value as it stands in the file, all `N` bytes of it.
    fn to_bytes<const N: usize>(self) -> [u8; N] {
        const { assert!(N == size_of::<Self>(), "a record has the size of its fields") };
        let mut out = [0; N];
        self.put(&mut out.iter_mut());
        out
    }
}

/// Numbers as fields.
macro_rules! number_fields {
    ($($number:ty)*) => { $(
        impl Field for $number {
            #[inline]
            fn take(bytes: &mut &[u8]) -> Self {
                Self::from_le_bytes(Field::take(bytes))
            }

            #[inline]
            fn put<'o>(self, out: &mut impl Iterator<Item = &'o mut u8>) {
                self.to_le_bytes().put(out);
            }
        }
    )* };
}

number_fields!(u8 u16 u32 u64 i16 f32);

impl<const N: usize> Field for [u8; N] {
    #[inline]
    fn take(bytes: &mut &[u8]) -> Self {
        let (first, rest) = bytes.split_first_chunk().unwrap_or((&[0; N], &[]));
        *bytes = rest;
        *first
    }

    #[inline]
    fn put<'o>(self, out: &mut impl Iterator<Item = &'o mut u8>) {
        self.into_iter().zip(out).for_each(|(byte, place)| *place = byte);
    }
}

/// A record from its list of fields: the struct, and [`Field`], which reads and writes it. Its size in the file is `size_of`.
macro_rules! record {
    ($(#[$about:meta])* $record:ident { $($(#[$about_field:meta])* $field:ident: $type:ty,)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug)]
        #[repr(C, packed)]
        pub(crate) struct $record {
            $($(#[$about_field])* pub(crate) $field: $type,)*
        }

        impl $crate::container::record::Field for $record {
            #[inline]
            fn take(bytes: &mut &[u8]) -> Self {
                // Fields are evaluated in the order in which they are written.
                Self { $($field: $crate::container::record::Field::take(bytes),)* }
            }

            #[inline]
            fn put<'o>(self, out: &mut impl Iterator<Item = &'o mut u8>) {
                $($crate::container::record::Field::put(self.$field, out);)*
            }
        }
    };
}

pub(crate) use record;

#[cfg(test)]
mod tests {
    use super::Field;
    use core::mem::offset_of;

    record! {
        /// Fields that would have gaps between them otherwise.
        Example { small: u8, wide: u32, name: [u8; 4], real: f32, signed: i16, long: u64, }
    }

    #[test]
    fn fields_follow_each_other_without_gaps() {
        assert_eq!(size_of::<Example>(), 23);
        assert_eq!([offset_of!(Example, wide), offset_of!(Example, real), offset_of!(Example, long)], [1, 9, 15]);
        let bytes: [u8; 23] = core::array::from_fn(|at| u8::try_from(at).unwrap_or(0));
        let record = Example::from_bytes(&bytes);
        assert_eq!({ record.wide }, 0x0403_0201);
        assert_eq!(record.name, [5, 6, 7, 8]);
        assert_eq!({ record.signed }, 0x0E0D);
        assert_eq!(record.to_bytes::<23>(), bytes);
    }

    #[test]
    fn what_is_missing_is_zero() {
        let record = Example::from_bytes(&[1, 2, 3]);
        assert_eq!(({ record.small }, { record.wide }, { record.long }), (1, 0, 0), "a part of a field is none");
    }
}
