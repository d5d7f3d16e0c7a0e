//! What holds for any error of any input.

use std::fmt::{self, Write};
use subsurf_decoder::container::{MAJOR, MAX_SECTIONS};
use subsurf_decoder::{ReadError, Section};

/// Longest message.
const MOST_BYTES: usize = 200;

/// Counts bytes of a message, and keeps none.
struct Count(usize);

impl Write for Count {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0 += text.len();
        Ok(())
    }
}

/// Checks that an error is true: what it says is wrong is wrong, and stands within the input.
///
/// # Panics
/// If it is not.
pub fn check_error(error: ReadError, input: &[u8]) {
    let length = input.len() as u64;
    let is_true = match error {
        ReadError::NotSubsurf | ReadError::UnknownContent | ReadError::Missing { .. } | ReadError::Duplicate { .. } => {
            true
        }
        ReadError::NewerVersion { major, .. } => major != MAJOR,
        ReadError::NewerSection { section } => matches!(section, Section::Other(_)) && section.is_critical(),
        ReadError::TwoFamilies { headers: [first, second] } => first != second,
        ReadError::OtherFamily { found, expected } => found != expected,
        ReadError::Truncated { need_bytes, have_bytes, .. } => have_bytes < need_bytes && have_bytes <= length,
        ReadError::SectionCount { count, limit } => limit == MAX_SECTIONS && !(1..=limit).contains(&count),
        ReadError::Overlap { offset, earliest, .. } => offset < earliest && earliest <= length,
        ReadError::Checksum { stored, computed, .. } => stored != computed,
        ReadError::WrongSize { need_bytes, have_bytes, .. } => need_bytes != have_bytes,
        ReadError::BadField { offset, .. } => offset < length,
        ReadError::BadNumber { offset, value, min, max, .. } => {
            // Where nothing may follow, the range is empty.
            let is_within = min.total_cmp(&value).is_le() && value.total_cmp(&max).is_le();
            offset < length && !min.is_nan() && !max.is_nan() && !is_within
        }
        ReadError::IndexOutOfRange { offset, index, len, .. } => offset < length && index >= len,
        _ => true,
    };
    assert!(is_true, "{error:?} in {length} bytes: {error}");
    let mut count = Count(0);
    write!(count, "{error}").expect("a message");
    assert!((1..=MOST_BYTES).contains(&count.0), "{error}");
}
