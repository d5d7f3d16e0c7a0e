//! Opaque handles: memory whose first word says what it is, as far as misuse can be told at all.

use core::ptr::NonNull;

use crate::border::not_null;
use crate::failure::Failure;
use crate::memory::{allocate, release};

/// What is behind a kind of handles.
pub trait Kind {
    /// Name of the handle in the header.
    const NAME: &'static str;
    /// First word of a handle that is open.
    const WORD: u64;
}

/// Memory of a handle.
#[repr(C)]
pub struct Handle<T> {
    word: u64,
    value: T,
}

impl<T: Kind> Handle<T> {
    /// Handle of a value.
    pub fn create(value: T) -> Result<NonNull<Self>, Failure<'static>> {
        allocate(Self { word: T::WORD, value }).ok_or(Failure::Memory { need_bytes: size_of::<Self>() as u64 })
    }

    /// Whether a pointer is a handle of this kind that is open.
    ///
    /// # Safety
    /// `handle` is null or leads to a word for reading. Memory of a closed handle may have any word.
    unsafe fn check(name: &'static str, handle: *const Self) -> Result<(), Failure<'static>> {
        not_null(name, handle)?;
        // SAFETY: aligned where it is read, and of one word at least, the caller promises.
        let is_open = handle.is_aligned() && unsafe { (&raw const (*handle).word).read() } == T::WORD;
        if is_open { Ok(()) } else { Err(Failure::NotHandle { name, expected: T::NAME }) }
    }

    /// The value of a handle, which is called `name` in the header.
    ///
    /// # Safety
    /// `handle` is null, or one of this library that is open, of any kind, and stays open for `'h`.
    pub unsafe fn of<'h>(name: &'static str, handle: *const Self) -> Result<&'h T, Failure<'static>> {
        // SAFETY: the caller's word.
        unsafe { Self::check(name, handle) }?;
        // SAFETY: the word was that of this kind.
        Ok(unsafe { &(*handle).value })
    }

    /// The value of a handle, to change it.
    ///
    /// # Safety
    /// As [`Self::of`], and nothing else uses the value meanwhile.
    pub unsafe fn of_mut<'h>(name: &'static str, handle: *mut Self) -> Result<&'h mut T, Failure<'static>> {
        // SAFETY: the caller's word.
        unsafe { Self::check(name, handle) }?;
        // SAFETY: the word was that of this kind.
        Ok(unsafe { &mut (*handle).value })
    }

    /// Drops the value and its memory; nothing where there is no such handle.
    ///
    /// # Safety
    /// As [`Self::of_mut`], and the handle is not used again.
    pub unsafe fn close(handle: *mut Self) {
        // SAFETY: the caller's word.
        if unsafe { Self::check("handle", handle) }.is_err() {
            return;
        }
        let Some(place) = NonNull::new(handle) else { return };
        // SAFETY: the handle is open and given up. Its word is gone before its memory is, should it be used again.
        unsafe {
            (&raw mut (*handle).word).write_volatile(0);
            release(place);
        }
    }
}
