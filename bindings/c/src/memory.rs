//! Memory from malloc: what cannot be had is an error, not the end of the process.

use core::mem::align_of;
use core::ptr::NonNull;

/// Alignment that malloc promises everywhere.
const MALLOC_ALIGN: usize = 8;

/// Moves a value to memory of its own; `None` if there is none.
pub(crate) fn allocate<T>(value: T) -> Option<NonNull<T>> {
    const { assert!(align_of::<T>() <= MALLOC_ALIGN, "malloc aligns it") };
    // SAFETY: malloc takes any size.
    let place = NonNull::new(unsafe { libc::malloc(size_of::<T>()) }.cast::<T>())?;
    // SAFETY: malloc gave this memory, large enough and aligned, and nothing else points to it.
    unsafe { place.write(value) };
    Some(place)
}

/// Drops a value of [`allocate`] and frees its memory.
///
/// # Safety
/// `place` comes from [`allocate`], and is not used again.
pub(crate) unsafe fn release<T>(place: NonNull<T>) {
    // SAFETY: the caller gives up a value that is still there.
    unsafe { place.drop_in_place() };
    // SAFETY: the memory is malloc's.
    unsafe { libc::free(place.as_ptr().cast()) };
}

/// Number for which all bits zero are a value.
pub(crate) trait Number: Copy {}
impl Number for i8 {}
impl Number for i16 {}
impl Number for f32 {}

/// Numbers, zeros at first.
pub(crate) struct Numbers<T: Number> {
    place: NonNull<T>,
    len: usize,
}

// SAFETY: it owns its numbers, which any thread may read and drop.
unsafe impl<T: Number + Send> Send for Numbers<T> {}
// SAFETY: shared, they are only read.
unsafe impl<T: Number + Sync> Sync for Numbers<T> {}

impl<T: Number> Numbers<T> {
    /// `len` zeros; `None` if there is no such memory.
    pub(crate) fn zeros(len: usize) -> Option<Self> {
        const { assert!(align_of::<T>() <= MALLOC_ALIGN, "malloc aligns it") };
        // calloc may give nothing for nothing.
        // SAFETY: calloc takes any sizes, and gives nothing where their product overflows.
        let place = NonNull::new(unsafe { libc::calloc(len.max(1), size_of::<T>()) }.cast::<T>())?;
        Some(Self { place, len })
    }

    /// All numbers, for as long as the caller knows that this is neither moved to another owner's care nor dropped.
    ///
    /// # Safety
    /// `self` outlives `'n`, and nothing else uses the numbers meanwhile.
    pub(crate) unsafe fn slice<'n>(&mut self) -> &'n mut [T] {
        // SAFETY: `len` numbers are there, zeros at least; the caller sees to the rest.
        unsafe { core::slice::from_raw_parts_mut(self.place.as_ptr(), self.len) }
    }
}

impl<T: Number> Drop for Numbers<T> {
    fn drop(&mut self) {
        // SAFETY: the memory is calloc's and this its only owner.
        unsafe { libc::free(self.place.as_ptr().cast()) };
    }
}
