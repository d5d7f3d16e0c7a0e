//! Text of the last failure of each thread, by the keys of POSIX threads: Android 7 has no other thread-local storage.

use core::ffi::{c_char, c_void};
use core::fmt;
use core::ptr;
use core::sync::atomic::{AtomicUsize, Ordering};

use crate::line::Line;

/// Bits of the key of the thread's text, plus one; 0 before there is one. Android's keys are negative, Linux' begin at 0.
static KEY: AtomicUsize = AtomicUsize::new(0);

/// Key that all threads share; `None` if the process has no more of them.
#[allow(
    clippy::as_conversions,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    clippy::unnecessary_cast,
    reason = "bits come back as they went, whatever integer a system's keys are"
)]
fn key() -> Option<libc::pthread_key_t> {
    loop {
        let known = KEY.load(Ordering::Acquire);
        if known != 0 {
            return Some(known.wrapping_sub(1) as libc::pthread_key_t);
        }
        let mut key = 0;
        // A thread's text is freed by libc itself, which stays when this library is unloaded.
        let free: unsafe extern "C" fn(*mut c_void) = libc::free;
        // SAFETY: `key` is there to be written to, and what threads keep under it is malloc's.
        if unsafe { libc::pthread_key_create(&raw mut key, Some(free)) } != 0 {
            return None;
        }
        let ours = (key as usize).wrapping_add(1);
        if KEY.compare_exchange(0, ours, Ordering::AcqRel, Ordering::Acquire).is_err() {
            // Another thread was first; its key serves all.
            // SAFETY: nobody knows this key.
            unsafe { libc::pthread_key_delete(key) };
        }
    }
}

/// This thread's text; null if it has none.
fn existing() -> *mut Line {
    // SAFETY: the key was created, and is not deleted.
    key().map_or(ptr::null_mut(), |key| unsafe { libc::pthread_getspecific(key) }.cast())
}

/// Writes this thread's text. Without memory for it, the text is an older one, or empty.
pub(crate) fn set(text: fmt::Arguments<'_>) {
    let mut line = existing();
    if line.is_null() {
        let Some(key) = key() else { return };
        // SAFETY: calloc takes any size.
        line = unsafe { libc::calloc(1, size_of::<Line>()) }.cast();
        // SAFETY: the key is there, and so is what it is to have.
        if line.is_null() || unsafe { libc::pthread_setspecific(key, line.cast()) } != 0 {
            // SAFETY: the memory is calloc's, and nobody knows it.
            unsafe { libc::free(line.cast()) };
            return;
        }
    }
    // SAFETY: this thread alone uses what is under its key; zeros are a line.
    unsafe { &mut *line }.set(text);
}

/// This thread's text, zero-terminated.
pub(crate) fn pointer() -> *const c_char {
    let line = existing();
    if line.is_null() {
        return c"".as_ptr();
    }
    // SAFETY: as in `set`.
    unsafe { &*line }.pointer()
}
