//! Files as the pages that the system maps: nothing is read before it is looked at, and nothing is copied.

use core::ffi::{CStr, c_int};
use core::fmt;
use core::ptr::{self, NonNull};

use crate::extent::{NoExtent, extent};

/// Bytes of a file, mapped for reading.
pub(crate) struct Mapping {
    /// First page.
    address: NonNull<u8>,
    /// Bytes that are mapped.
    mapped: usize,
    /// Where in them what was asked for begins.
    start: usize,
}

// SAFETY: the pages are only read, and any thread may unmap them.
unsafe impl Send for Mapping {}
// SAFETY: the pages are only read.
unsafe impl Sync for Mapping {}

/// Why a file could not be mapped.
#[derive(Clone, Copy)]
pub enum MapError {
    /// System call of this name failed with an `errno`.
    System { call: &'static str, errno: c_int },
    /// Not a file that has a length.
    NotRegular,
    /// The bytes that were asked for cannot be mapped.
    Extent(NoExtent),
    /// This system maps no bytes so far behind the start of a file.
    TooFar { offset: u64 },
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::System { call, errno } => {
                let mut text = [0; 128];
                // SAFETY: the buffer is as long as it says.
                let known = unsafe { libc::strerror_r(errno, text.as_mut_ptr().cast(), text.len()) } == 0;
                let text = CStr::from_bytes_until_nul(&text).ok().and_then(|text| text.to_str().ok());
                match text.filter(|_| known) {
                    Some(text) => write!(f, "{call}: {text}"),
                    None => write!(f, "{call}: error {errno}"),
                }
            }
            Self::NotRegular => f.write_str("not a regular file, which can be mapped: read it, and open its bytes"),
            Self::Extent(error) => error.fmt(f),
            Self::TooFar { offset } => {
                write!(f, "byte {offset} is further than this system maps: read the bytes instead")
            }
        }
    }
}

/// Last error of the system in this thread.
fn errno() -> c_int {
    // SAFETY: every thread has such a place.
    unsafe {
        #[cfg(any(target_os = "linux", target_os = "emscripten"))]
        return *libc::__errno_location();
        #[cfg(target_os = "android")]
        return *libc::__errno();
        #[cfg(any(target_vendor = "apple", target_os = "freebsd"))]
        return *libc::__error();
    }
}

fn system(call: &'static str) -> MapError {
    MapError::System { call, errno: errno() }
}

/// A mode or a part of it: systems have them in 16 bits or in 32, and Android for 32-bit machines in both.
fn wide(mode: impl Into<u32>) -> u32 {
    mode.into()
}

impl Mapping {
    /// Maps a whole file.
    pub(crate) fn of_path(path: &CStr) -> Result<Self, MapError> {
        // SAFETY: the path ends with a zero.
        let fd = unsafe { libc::open(path.as_ptr(), libc::O_RDONLY | libc::O_CLOEXEC) };
        if fd < 0 {
            return Err(system("open"));
        }
        let mapping = Self::of_fd(fd, 0, None);
        // SAFETY: it was opened above, and mappings do without it.
        unsafe { libc::close(fd) };
        mapping
    }

    /// Maps `length` bytes of an open file, or all, from `offset`, which need not be the start of a page.
    pub(crate) fn of_fd(fd: c_int, offset: u64, length: Option<u64>) -> Result<Self, MapError> {
        // SAFETY: zeros are a value of these numbers.
        let mut stat: libc::stat = unsafe { core::mem::zeroed() };
        // SAFETY: `stat` is there to be written to, and a number that is no file is refused.
        if unsafe { libc::fstat(fd, &raw mut stat) } != 0 {
            return Err(system("fstat"));
        }
        if wide(stat.st_mode) & wide(libc::S_IFMT) != wide(libc::S_IFREG) {
            return Err(MapError::NotRegular);
        }
        let have_bytes = u64::try_from(stat.st_size).unwrap_or(0);
        let length = extent(offset, length, have_bytes).map_err(MapError::Extent)?;
        // Mappings begin where pages do.
        // SAFETY: it only asks for a number.
        let page = u64::try_from(unsafe { libc::sysconf(libc::_SC_PAGESIZE) }).unwrap_or(1);
        let start = offset.checked_rem(page).unwrap_or(0);
        let first = libc::off_t::try_from(offset.saturating_sub(start)).map_err(|_| MapError::TooFar { offset })?;
        // With the rest of its first page, too, they are no more than a slice has.
        let mapped = isize::try_from(length.saturating_add(start)).ok().and_then(|mapped| usize::try_from(mapped).ok());
        let mapped = mapped.ok_or(MapError::Extent(NoExtent::TooLong { length }))?;
        // SAFETY: the system chooses the place of new pages, which nothing else uses.
        let address = unsafe { libc::mmap(ptr::null_mut(), mapped, libc::PROT_READ, libc::MAP_PRIVATE, fd, first) };
        match NonNull::new(address.cast::<u8>()).filter(|_| address != libc::MAP_FAILED) {
            // Less than a page, which a `usize` holds.
            Some(address) => Ok(Self { address, mapped, start: usize::try_from(start).unwrap_or(0) }),
            None => Err(system("mmap")),
        }
    }

    /// The bytes that were asked for.
    pub(crate) fn bytes(&self) -> &[u8] {
        // SAFETY: the pages are mapped for reading until this is dropped.
        let mapped = unsafe { core::slice::from_raw_parts(self.address.as_ptr(), self.mapped) };
        mapped.get(self.start..).unwrap_or_default()
    }
}

impl Drop for Mapping {
    fn drop(&mut self) {
        // SAFETY: these pages are this mapping's own, and whoever borrowed them is gone.
        unsafe { libc::munmap(self.address.as_ptr().cast(), self.mapped) };
    }
}
