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
    /// The budget of a renderer, or what is left of it, is too small for the picture; nothing was allocated.
    OverBudget = 7,
    /// The device cannot hold something of that size, or draw it; the text says which.
    Unsupported = 8,
    /// There is no such device.
    NoDevice = 9,
    /// The device or its driver failed: another backend may do better.
    DeviceFailed = 10,
    /// The device is lost, as by a reset of its driver: close what was made on it, open it again, load again.
    DeviceLost = 11,
    /// The mesh is broken or empty, or lacks what its material needs.
    InvalidMesh = 12,
    /// The window shows no pictures any more: close its surface, and open one of the window that is there now.
    SurfaceLost = 13,
    /// The window takes no picture at present, as when it is covered: try again later.
    Skipped = 14,
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
#[allow(missing_docs, reason = "fields are named for the messages that they are in")]
pub enum Failure<'a> {
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
    /// What only other crates know of.
    Other {
        status: SubsurfStatus,
        text: &'a dyn fmt::Display,
    },
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
            Self::Other { status, .. } => status,
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
            Self::Other { text, .. } => text.fmt(f),
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
pub fn status_of(result: Result<(), Failure<'_>>) -> SubsurfStatus {
    match result {
        Ok(()) => SubsurfStatus::Ok,
        Err(failure) => {
            text::set(format_args!("{failure}"));
            failure.status()
        }
    }
}
