//! What callers hand in: structs of their version, arrays, numbers in range.

use subsurf_c::shared::{Failure, Versioned, in_memory, not_null, read, sized};

use crate::fault::{Fault, Result};

/// Struct of a caller; fields that the caller's version does not have are those of `later`.
///
/// # Safety
/// `pointer` is null or leads to as many bytes as its first field, `struct_size`, says; any bytes are a `T`.
pub(crate) unsafe fn take<T: Versioned>(name: &'static str, pointer: *const T, later: T) -> Result<T> {
    // SAFETY: every such struct begins with its size.
    let found = unsafe { read(name, pointer.cast::<u32>()) }? as usize;
    // SAFETY: as many bytes are there, the caller promises.
    unsafe { take_sized(T::NAME, pointer.cast(), found, T::FIRST_BYTES, later) }
}

/// Refuses a struct of a caller that is too small to be filled, before the work that it would tell of; null is none.
///
/// # Safety
/// `pointer` is null or leads to a struct that begins with its size.
pub(crate) unsafe fn fillable<T: Versioned>(name: &'static str, pointer: *const T) -> Result<()> {
    if pointer.is_null() {
        return Ok(());
    }
    // SAFETY: the caller's word.
    unsafe { sized(name, pointer) }?;
    Ok(())
}

/// Element of an array of structs of a caller's version, `found` bytes each.
///
/// # Safety
/// `pointer` leads to `found` bytes; any bytes are a `T`.
unsafe fn take_sized<T: Copy>(name: &'static str, from: *const u8, found: usize, first: usize, later: T) -> Result<T> {
    if found < first {
        return Err(Failure::StructSize { name, found, expected: first }.into());
    }
    let mut value = later;
    // SAFETY: no more bytes than either has.
    unsafe { from.copy_to_nonoverlapping((&raw mut value).cast(), found.min(size_of::<T>())) };
    Ok(value)
}

/// Array of a caller, of structs of its version.
#[derive(Clone, Copy)]
pub(crate) struct Structs<T> {
    /// Name of the pointer in the header.
    pub(crate) name: &'static str,
    /// Name of the struct.
    pub(crate) of: &'static str,
    pub(crate) pointer: *const T,
    pub(crate) count: u32,
    /// Bytes from one to the next: the caller's size of the struct.
    pub(crate) bytes: u32,
    /// Most that there may be.
    pub(crate) most: u32,
}

impl<T: Copy> Structs<T> {
    /// All elements. `first`: bytes of the first version of the struct.
    ///
    /// # Safety
    /// `pointer` is null or leads to `count` times `bytes` bytes; any bytes are a `T`.
    pub(crate) unsafe fn take(self, first: usize, later: T) -> Result<Vec<T>> {
        let Self { name, of, pointer, count, bytes, most } = self;
        if count == 0 {
            return Ok(Vec::new());
        }
        not_null(name, pointer)?;
        if count > most {
            return Err(Fault::invalid(format!("{count} {name}, expected are {most} at most")));
        }
        let element = |k: u32| {
            let bytes = bytes as usize;
            // SAFETY: elements are one after the other, and within the array.
            unsafe { take_sized(of, pointer.cast::<u8>().add(k as usize * bytes), bytes, first, later) }
        };
        (0..count).map(element).collect()
    }
}

/// Array of numbers.
///
/// # Safety
/// `pointer` is null or leads to `count` times `T`, for which any bytes are a value.
pub(crate) unsafe fn array<T: Copy>(name: &'static str, pointer: *const T, count: usize) -> Result<Vec<T>> {
    not_null(name, pointer)?;
    let bytes = count.saturating_mul(size_of::<T>());
    in_memory(name, bytes)?;
    let mut values = Vec::<T>::new();
    let none = |_| Failure::Memory { need_bytes: bytes as u64 };
    values.try_reserve_exact(count).map_err(none)?;
    // SAFETY: there is room for as many, which are there, of any alignment.
    unsafe {
        pointer.cast::<u8>().copy_to_nonoverlapping(values.as_mut_ptr().cast::<u8>(), bytes);
        values.set_len(count);
    }
    Ok(values)
}

/// Array of numbers that may be left out.
///
/// # Safety
/// As [`array`].
pub(crate) unsafe fn optional<T: Copy>(name: &'static str, pointer: *const T, count: usize) -> Result<Option<Vec<T>>> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's word.
    unsafe { array(name, pointer, count) }.map(Some)
}

/// Refuses numbers that are not finite.
pub(crate) fn finite(what: &str, numbers: &[f32]) -> Result<()> {
    match numbers.iter().find(|number| !number.is_finite()) {
        Some(number) => Err(Fault::invalid(format!("{what} has {number}, expected are finite numbers"))),
        None => Ok(()),
    }
}

/// Refuses a number that is not finite or not in a range.
pub(crate) fn within(what: &str, number: f32, range: std::ops::RangeInclusive<f32>) -> Result<()> {
    if range.contains(&number) {
        return Ok(());
    }
    let (low, high) = range.into_inner();
    Err(Fault::invalid(format!("{what} is {number}, expected is {low} to {high}")))
}

/// The value that stands for a number of an enumeration.
pub(crate) fn one_of<T: Copy>(what: &'static str, number: u32, values: &[T]) -> Result<T> {
    let out_of_range = Failure::OutOfRange { what, value: number.into(), len: values.len() as u64 };
    Ok(*values.get(number as usize).ok_or(out_of_range)?)
}
