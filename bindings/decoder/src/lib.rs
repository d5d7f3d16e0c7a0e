//! `libsubsurf_decoder.so`: the functions of `subsurf.h` that read and evaluate files, without a renderer.
//!
//! Where panics abort, as they do in the profile `bindings`, neither Rust's standard library nor its allocator is in it.
#![cfg_attr(all(unix, panic = "abort"), no_std)]

use subsurf_c as _;

/// End of the process. No function of the library can get here: the linker leaves this out, and a test looks for it.
#[cfg(all(unix, panic = "abort"))]
#[panic_handler]
fn subsurf_panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: abort takes nothing and does not return.
    unsafe { libc::abort() }
}
