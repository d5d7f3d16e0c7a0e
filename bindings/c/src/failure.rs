//! What can go wrong: a status to branch on, and one line of text for each thread.

use core::ffi::c_char;
use core::fmt;

use subsurf_decoder::{Family, ReadError};

use crate::map::MapError;
use crate::text;

/// Outcome of a call. After all but `SUBSURF_STATUS_OK`, `subsurf_last_error` says what was wrong, and nothing was written to
/// what the caller pointed to. Later versions may add others.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubsurfStatus {
    /// The call did what it is for.
    Ok = 0,
    /// A pointer is null, a handle is none, a `struct_size` is too small, or a number is out of range: the program is wrong.
    InvalidArgument = 1,
    /// The operating system did not open or map the file.
    Io = 2,
    /// The bytes are not a sound `.subsurf` file, or one of a later format.
    InvalidFile = 3,
    /// The function is for files of another family, or model.
    WrongFamily = 4,
    /// There is not enough memory.
    OutOfMemory = 5,
    /// The file is a factored BTF: call `subsurf_btf_expand` first.
    NotExpanded = 6,
}

/// Text of the last call of this thread that failed: one line in UTF-8 that says what is wrong and what is expected; empty
/// before the first.
///
/// Ownership: the library's; valid until the next call of this thread that fails, or the thread's end. Never null.
/// Threads: each has its own text.
#[unsafe(no_mangle)]
pub extern "C" fn subsurf_last_error() -> *const c_char {
    text::pointer()
}

/// Reason why a call fails.
#[derive(Clone, Copy)]
pub(crate) enum Failure<'a> {
    /// Pointer of this name is null.
    Null(&'static str),
    /// Not a handle of the kind that is expected.
    NotHandle {
        name: &'static str,
        expected: &'static str,
    },
    StructSize {
        name: &'static str,
        found: usize,
        expected: usize,
    },
    OutOfRange {
        what: &'static str,
        value: u64,
        len: u64,
    },
    /// No texel at these coordinates: material and level.
    NoTexel {
        material: u32,
        level: u32,
    },
    Map {
        path: Option<&'a [u8]>,
        error: MapError,
    },
    Read {
        path: Option<&'a [u8]>,
        error: ReadError,
    },
    Family {
        found: Family,
        expected: &'static str,
    },
    Memory {
        need_bytes: u64,
    },
    NotExpanded,
}

impl Failure<'_> {
    fn status(self) -> SubsurfStatus {
        match self {
            Self::Null(_)
            | Self::NotHandle { .. }
            | Self::StructSize { .. }
            | Self::OutOfRange { .. }
            | Self::NoTexel { .. } => SubsurfStatus::InvalidArgument,
            Self::Map { .. } => SubsurfStatus::Io,
            Self::Read { .. } => SubsurfStatus::InvalidFile,
            Self::Family { .. } => SubsurfStatus::WrongFamily,
            Self::Memory { .. } => SubsurfStatus::OutOfMemory,
            Self::NotExpanded => SubsurfStatus::NotExpanded,
        }
    }
}

impl fmt::Display for Failure<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Null(name) => write!(f, "{name} is null"),
            Self::NotHandle { name, expected } => write!(f, "{name} is not a {expected} that is open"),
            Self::StructSize { name, found, expected } => {
                write!(f, "struct_size is {found}, expected are {expected} at least: set it to sizeof({name})")
            }
            Self::OutOfRange { what, value, len } => write!(f, "{what} is {value}, expected is less than {len}"),
            Self::NoTexel { material, level } => write!(f, "there is no level {level} of a material {material}"),
            Self::Map { path, error } => Named(path).fmt(f).and_then(|()| error.fmt(f)),
            Self::Read { path, error } => Named(path).fmt(f).and_then(|()| error.fmt(f)),
            Self::Family { found, expected } => write!(f, "the file is a {found}, expected is a {expected}"),
            Self::Memory { need_bytes } => write!(f, "there is no memory of {need_bytes} bytes"),
            Self::NotExpanded => f.write_str("a factored BTF is evaluated once subsurf_btf_expand was called"),
        }
    }
}

/// Path before a message, as far as it is text; nothing where there is none.
struct Named<'a>(Option<&'a [u8]>);

impl fmt::Display for Named<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(Some(path)) = self else { return Ok(()) };
        for chunk in path.utf8_chunks() {
            f.write_str(chunk.valid())?;
            if !chunk.invalid().is_empty() {
                f.write_str("\u{FFFD}")?;
            }
        }
        f.write_str(": ")
    }
}

/// Status of a call, whose failure becomes the thread's text.
pub(crate) fn status_of(result: Result<(), Failure<'_>>) -> SubsurfStatus {
    match result {
        Ok(()) => SubsurfStatus::Ok,
        Err(failure) => {
            text::set(format_args!("{failure}"));
            failure.status()
        }
    }
}
