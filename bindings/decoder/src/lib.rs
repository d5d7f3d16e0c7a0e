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

// Divisions of 64 bits on 32-bit ARM come from a library of Rust's that unwinds, and name the function by which it does: it lies in the
// standard library. This one in its place says that there is no way on (`_URC_FAILURE` of ARM's EHABI), is not exported, and is weak, so that
// the standard library's is taken where another library of Rust's brings it along.
#[cfg(all(unix, panic = "abort", target_arch = "arm"))]
core::arch::global_asm!(
    ".arm",
    ".hidden rust_eh_personality",
    ".weak rust_eh_personality",
    ".type rust_eh_personality, %function",
    "rust_eh_personality:",
    "mov r0, #9",
    "bx lr",
);
