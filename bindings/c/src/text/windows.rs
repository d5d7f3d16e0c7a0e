//! Text of the last failure of each thread, by Rust's thread-local storage.

extern crate std;

use core::cell::RefCell;
use core::ffi::c_char;
use core::fmt;

use crate::line::Line;

std::thread_local! {
    static LINE: RefCell<Line> = const { RefCell::new(Line::EMPTY) };
}

/// Writes this thread's text; once the thread is about to end, none.
pub(crate) fn set(text: fmt::Arguments<'_>) {
    let _ = LINE.try_with(|line| line.try_borrow_mut().map(|mut line| line.set(text)));
}

/// This thread's text, zero-terminated.
pub(crate) fn pointer() -> *const c_char {
    LINE.try_with(|line| line.try_borrow().map(|line| line.pointer()).unwrap_or(c"".as_ptr())).unwrap_or(c"".as_ptr())
}
