//! Which bytes of a file are asked for, whether they are there, and whether a process can have them at once.

use core::fmt;

/// Why the bytes that were asked for are none that can be mapped.
#[derive(Clone, Copy)]
pub enum NoExtent {
    /// They are not in the file.
    Beyond {
        offset: u64,
        length: u64,
        have_bytes: u64,
    },
    /// This process has no room for so many.
    TooLong {
        length: u64,
    },
    Empty,
}

/// Number of bytes, one or more and in no slice too many: `length` of them, or all, from `offset` in a file of `have_bytes`.
pub(crate) fn extent(offset: u64, length: Option<u64>, have_bytes: u64) -> Result<u64, NoExtent> {
    let rest = have_bytes.saturating_sub(offset);
    let length = length.unwrap_or(rest);
    if offset > have_bytes || length > rest {
        return Err(NoExtent::Beyond { offset, length, have_bytes });
    }
    if length == 0 {
        return Err(NoExtent::Empty);
    }
    // No slice is longer than half of the addresses.
    if isize::try_from(length).is_err() {
        return Err(NoExtent::TooLong { length });
    }
    Ok(length)
}

impl fmt::Display for NoExtent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Beyond { offset, length, have_bytes } => {
                write!(f, "the file has {have_bytes} bytes, expected are {length} from byte {offset} on")
            }
            Self::TooLong { length } => write!(f, "{length} bytes are more than this process can map at once"),
            Self::Empty => f.write_str("the file has no bytes to map"),
        }
    }
}
