//! Files of the host that emulates the board, by semihosting.

use core::ffi::CStr;
use cortex_m_semihosting::syscall;

/// File of the host, open for reading.
pub(crate) struct File(usize);

impl File {
    pub(crate) fn open(path: &CStr) -> Self {
        /// `rb`.
        const READ: usize = 1;
        // SAFETY: the call reads a string of the length that it is given.
        Self(unsafe { syscall!(OPEN, path.as_ptr(), READ, path.count_bytes()) })
    }

    /// The next bytes, none at the end.
    pub(crate) fn read<'b>(&mut self, room: &'b mut [u8]) -> &'b [u8] {
        // SAFETY: the call writes to no more bytes than it is given. It returns how many of them it left.
        let left = unsafe { syscall!(READ, self.0, room.as_mut_ptr(), room.len()) };
        room.get(..room.len().saturating_sub(left)).unwrap_or(&[])
    }
}
