//! Conversions between the numbers of Java, which have signs, and those of C.

use jni_sys::{jint, jlong};

/// Pointer of a handle that travelled as a `long`.
pub(crate) fn pointer<T>(handle: jlong) -> *mut T {
    #[allow(clippy::cast_possible_truncation, reason = "it was a pointer")]
    let address = handle as usize;
    core::ptr::with_exposed_provenance_mut(address)
}

/// Handle as a `long`.
pub(crate) fn handle<T>(pointer: *mut T) -> jlong {
    #[allow(clippy::cast_possible_wrap, reason = "a pattern of bits")]
    let handle = pointer.expose_provenance() as jlong;
    handle
}

/// Number from 0 on, as Java has it.
pub(crate) fn int(value: u32) -> jint {
    jint::try_from(value).unwrap_or(jint::MAX)
}

/// Number of bytes, as Java has it.
pub(crate) fn long(value: u64) -> jlong {
    jlong::try_from(value).unwrap_or(jlong::MAX)
}

/// Number from Java; what is negative there is out of any range here.
pub(crate) fn unsigned(value: jint) -> u32 {
    value.cast_unsigned()
}

/// Bytes of a struct, which it begins with.
pub(crate) fn struct_size<T>() -> u32 {
    u32::try_from(size_of::<T>()).unwrap_or(0)
}
