//! The number by which callers tell whether header and library belong together.

/// Version of the functions and structs of this header: the major number in the upper 16 bits, the minor one in the lower.
///
/// The major number grows when something that was there changes, the minor one when something is added.
pub const SUBSURF_ABI_VERSION: u32 = 0x0001_0000;

/// Version of the library that is loaded, as `SUBSURF_ABI_VERSION`.
///
/// It fits a program if its major number equals the header's, and it is not less than the header's.
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn subsurf_abi_version() -> u32 {
    SUBSURF_ABI_VERSION
}
