//! Files as the pages that the system maps: nothing is read before it is looked at, and nothing is copied.

extern crate std;

use core::ffi::{CStr, c_int};
use core::fmt;
use core::mem::ManuallyDrop;
use std::fs::File;
use std::io::Error;
use std::os::windows::io::{FromRawHandle, RawHandle};

use memmap2::{Mmap, MmapOptions};

use crate::extent::{NoExtent, extent};

/// Bytes of a file, mapped for reading.
pub(crate) struct Mapping(Mmap);

/// Why a file could not be mapped.
#[derive(Clone, Copy)]
pub enum MapError {
    /// The system failed with this code.
    System { call: &'static str, code: i32 },
    /// The path is not UTF-8.
    Path,
    /// The bytes that were asked for cannot be mapped.
    Extent(NoExtent),
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::System { call, code } => write!(f, "{call}: {}", Error::from_raw_os_error(code)),
            Self::Path => f.write_str("the path is not UTF-8"),
            Self::Extent(error) => error.fmt(f),
        }
    }
}

/// The system's number for a handle that is none.
const INVALID_HANDLE: i32 = 6;

fn system(call: &'static str) -> impl Fn(Error) -> MapError {
    move |error| MapError::System { call, code: error.raw_os_error().unwrap_or(0) }
}

impl Mapping {
    /// Maps a whole file, by its path in UTF-8.
    pub(crate) fn of_path(path: &CStr) -> Result<Self, MapError> {
        let path = path.to_str().map_err(|_| MapError::Path)?;
        Self::of_file(&File::open(path).map_err(system("open"))?, 0, None)
    }

    /// Maps `length` bytes of a file that the C library opened, or all, from `offset`.
    pub(crate) fn of_fd(fd: c_int, offset: u64, length: Option<u64>) -> Result<Self, MapError> {
        if fd < 0 {
            return Err(MapError::System { call: "get_osfhandle", code: INVALID_HANDLE });
        }
        // SAFETY: a number that was never a file's ends the process by the C library's own check, as it would in C.
        let handle = unsafe { libc::get_osfhandle(fd) };
        if handle < 0 {
            return Err(system("get_osfhandle")(Error::last_os_error()));
        }
        // SAFETY: the handle is open, and stays so for the caller.
        let file = ManuallyDrop::new(unsafe { File::from_raw_handle(handle as RawHandle) });
        Self::of_file(&file, offset, length)
    }

    fn of_file(file: &File, offset: u64, length: Option<u64>) -> Result<Self, MapError> {
        let have_bytes = file.metadata().map_err(system("stat"))?.len();
        let length = extent(offset, length, have_bytes).map_err(MapError::Extent)?;
        let too_long = MapError::Extent(NoExtent::TooLong { length });
        let length = usize::try_from(length).map_err(|_| too_long)?;
        // SAFETY: the caller promises that nobody changes the file while it is open.
        let map = unsafe { MmapOptions::new().offset(offset).len(length).map(file) };
        map.map(Self).map_err(system("map"))
    }

    /// The bytes that were asked for.
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.0
    }
}
