//! The border to C: pointers become references and values, or a failure that says which of them is none.

use crate::failure::Failure;

/// Value where a pointer leads; it needs no alignment.
///
/// # Safety
/// `pointer` is null or leads to a `T` for reading.
pub unsafe fn read<T: Copy>(name: &'static str, pointer: *const T) -> Result<T, Failure<'static>> {
    if pointer.is_null() {
        return Err(Failure::Null(name));
    }
    // SAFETY: not null, and so a `T`, the caller promises.
    Ok(unsafe { pointer.read_unaligned() })
}

/// Three numbers.
///
/// # Safety
/// `pointer` is null or leads to three `f32` for reading.
pub unsafe fn read3(name: &'static str, pointer: *const f32) -> Result<[f32; 3], Failure<'static>> {
    // SAFETY: as the caller promises.
    unsafe { read(name, pointer.cast()) }
}

/// Refuses a null pointer before there is anything to write to it.
pub fn not_null<T>(name: &'static str, pointer: *const T) -> Result<(), Failure<'static>> {
    if pointer.is_null() { Err(Failure::Null(name)) } else { Ok(()) }
}

/// Refuses more bytes than a slice has.
pub fn in_memory(name: &'static str, length: usize) -> Result<(), Failure<'static>> {
    let most = isize::MAX.unsigned_abs();
    let (value, len) = (length as u64, (most as u64).saturating_add(1));
    if length <= most { Ok(()) } else { Err(Failure::OutOfRange { what: name, value, len }) }
}

/// Writes a value where a pointer leads; it needs no alignment.
///
/// # Safety
/// `pointer` is null or leads to room for a `T`.
pub unsafe fn write<T>(name: &'static str, pointer: *mut T, value: T) -> Result<(), Failure<'static>> {
    not_null(name, pointer)?;
    // SAFETY: not null, and so room for a `T`, the caller promises.
    unsafe { pointer.write_unaligned(value) };
    Ok(())
}

/// Struct that later versions append fields to. Its first field is the caller's `sizeof`, a `u32`.
///
/// # Safety
/// `Self` is `repr(C)` and begins with that field.
pub unsafe trait Versioned: Copy {
    /// Name in the header.
    const NAME: &'static str;
    /// Bytes in the first version that had it.
    const FIRST_BYTES: usize;
}

/// Bytes of a caller's struct; refuses one that is smaller than its first version, before there is anything to write to it.
///
/// # Safety
/// `pointer` is null or leads to a struct that begins with its size.
pub unsafe fn sized<T: Versioned>(name: &'static str, pointer: *const T) -> Result<usize, Failure<'static>> {
    // SAFETY: every such struct begins with its size.
    let found = unsafe { read(name, pointer.cast::<u32>()) }? as usize;
    if found < T::FIRST_BYTES {
        return Err(Failure::StructSize { name: T::NAME, found, expected: T::FIRST_BYTES });
    }
    Ok(found)
}

/// Writes as much of a struct as the caller knows of, but for its size, which stays the caller's.
///
/// # Safety
/// `pointer` is null or leads to as many bytes as its first field, `struct_size`, says.
pub unsafe fn fill<T: Versioned>(name: &'static str, pointer: *mut T, value: T) -> Result<(), Failure<'static>> {
    // SAFETY: the caller's word.
    let found = unsafe { sized(name, pointer.cast_const()) }?;
    let after = size_of::<u32>();
    let bytes = found.min(size_of::<T>()).saturating_sub(after);
    // SAFETY: as many bytes are in `value`, and by the caller's word where the pointer leads.
    unsafe {
        let from = (&raw const value).cast::<u8>().add(after);
        from.copy_to_nonoverlapping(pointer.cast::<u8>().add(after), bytes);
    }
    Ok(())
}
