//! One line of text in a fixed buffer.

use core::ffi::c_char;
use core::fmt::{self, Write};

/// Bytes of a line, with the zero at its end. Longer ones are cut: a path of the longest kind fits.
const LINE_BYTES: usize = 4352;

/// Line of text, zero-terminated; zeros are an empty one.
pub(crate) struct Line {
    bytes: [u8; LINE_BYTES],
}

impl Line {
    /// Line without text.
    #[cfg(any(windows, test))]
    pub(crate) const EMPTY: Self = Self { bytes: [0; LINE_BYTES] };

    /// Replaces the text.
    pub(crate) fn set(&mut self, text: fmt::Arguments<'_>) {
        let (text_bytes, end) = self.bytes.split_at_mut(LINE_BYTES.saturating_sub(1));
        let mut rest = Rest(text_bytes);
        // A text that is cut is still a text.
        let _ = rest.write_fmt(text);
        if let Some(after) = rest.0.first_mut().or(end.first_mut()) {
            *after = 0;
        }
    }

    /// The text for C.
    pub(crate) fn pointer(&self) -> *const c_char {
        self.bytes.as_ptr().cast()
    }
}

/// What of a buffer is free.
struct Rest<'a>(&'a mut [u8]);

impl fmt::Write for Rest<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        // As much of the text as there is room for, cut between characters.
        let room = self.0.len().min(text.len());
        let fits = (0..=room).rev().find_map(|end| text.get(..end)).unwrap_or("");
        let (now, later) = core::mem::take(&mut self.0).split_at_mut_checked(fits.len()).unwrap_or_default();
        now.iter_mut().zip(fits.bytes()).for_each(|(place, byte)| *place = byte);
        self.0 = later;
        if fits.len() < text.len() { Err(fmt::Error) } else { Ok(()) }
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "a panic fails the test")]
mod tests {
    use super::*;
    use core::ffi::CStr;

    fn text(line: &Line) -> &str {
        CStr::from_bytes_until_nul(&line.bytes).expect("a zero").to_str().expect("UTF-8")
    }

    #[test]
    fn what_is_too_long_is_cut_between_characters() {
        let mut line = Line::EMPTY;
        line.set(format_args!("{}, {}", "one", 2));
        assert_eq!(text(&line), "one, 2");
        line.set(format_args!("short"));
        assert_eq!(text(&line), "short", "nothing of the longer text is left");
        line.set(format_args!("a{:é>9000}", ""));
        assert_eq!(text(&line).len(), LINE_BYTES - 1);
        line.set(format_args!("{:é>9000}", ""));
        assert_eq!(text(&line).len(), LINE_BYTES - 2, "a character is not split");
    }
}
