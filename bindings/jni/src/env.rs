//! Environment of a call: what is needed of the 230 functions of a virtual machine.

use core::ffi::{CStr, c_char};
use core::ptr::null_mut;

use jni_sys::{JNI_ABORT, JNIEnv, jbyteArray, jfloatArray, jint, jintArray, jlong, jlongArray, jobject, jsize};
use subsurf_c::SubsurfStatus;

use crate::convert::handle;

/// Environment of the calling thread.
#[derive(Clone, Copy)]
pub(crate) struct Env(*mut JNIEnv);

/// Calls a function of the environment's table.
macro_rules! call {
    ($env:expr, $version:ident, $name:ident $(, $argument:expr)*) => {{
        let env = $env.0;
        // SAFETY: the environment is this thread's, and the objects are of the declared types, as the crate says.
        unsafe { ((**env).$version.$name)(env $(, $argument)*) }
    }};
}

/// Length of a Java array.
fn length<T>(values: &[T]) -> jsize {
    jsize::try_from(values.len()).unwrap_or(jsize::MAX)
}

impl Env {
    /// Environment that the virtual machine passed to an entry point.
    ///
    /// # Safety
    /// It is that of the calling thread, and used in this call only.
    pub(crate) unsafe fn new(env: *mut JNIEnv) -> Self {
        Self(env)
    }

    /// Writes numbers to an array, which is as long at least.
    pub(crate) fn set_floats(self, array: jfloatArray, values: &[f32]) {
        call!(self, v1_1, SetFloatArrayRegion, array, 0, length(values), values.as_ptr());
    }

    /// Writes numbers to an array, which is as long at least.
    pub(crate) fn set_ints(self, array: jintArray, values: &[jint]) {
        call!(self, v1_1, SetIntArrayRegion, array, 0, length(values), values.as_ptr());
    }

    /// Writes numbers to an array, which is as long at least.
    pub(crate) fn set_longs(self, array: jlongArray, values: &[jlong]) {
        self.set_longs_at(array, 0, values);
    }

    /// Writes numbers to an array from an index on; it is as long at least.
    pub(crate) fn set_longs_at(self, array: jlongArray, index: jsize, values: &[jlong]) {
        call!(self, v1_1, SetLongArrayRegion, array, index, length(values), values.as_ptr());
    }

    /// Numbers of an array.
    pub(crate) fn floats(self, array: jfloatArray) -> Vec<f32> {
        let mut values = vec![0.0; usize::try_from(call!(self, v1_1, GetArrayLength, array)).unwrap_or(0)];
        call!(self, v1_1, GetFloatArrayRegion, array, 0, length(&values), values.as_mut_ptr());
        values
    }

    /// Numbers of an array.
    pub(crate) fn longs(self, array: jlongArray) -> Vec<jlong> {
        let mut values = vec![0; usize::try_from(call!(self, v1_1, GetArrayLength, array)).unwrap_or(0)];
        call!(self, v1_1, GetLongArrayRegion, array, 0, length(&values), values.as_mut_ptr());
        values
    }

    /// Array of bytes; null, with an exception of the virtual machine pending, where there is no memory.
    pub(crate) fn bytes(self, values: &[u8]) -> jbyteArray {
        let array = call!(self, v1_1, NewByteArray, length(values));
        if !array.is_null() {
            call!(self, v1_1, SetByteArrayRegion, array, 0, length(values), values.as_ptr().cast());
        }
        array
    }

    /// Calls with the bytes of an array, which ends with a zero.
    pub(crate) fn with_text(self, array: jbyteArray, work: impl FnOnce(*const c_char) -> jint) -> jint {
        let bytes = call!(self, v1_1, GetByteArrayElements, array, null_mut());
        if bytes.is_null() {
            return SubsurfStatus::OutOfMemory as jint;
        }
        let status = work(bytes.cast_const().cast());
        call!(self, v1_1, ReleaseByteArrayElements, array, bytes, JNI_ABORT);
        status
    }

    /// First byte of a direct buffer; null where there is none.
    pub(crate) fn address(self, buffer: jobject) -> *mut u8 {
        call!(self, v1_4, GetDirectBufferAddress, buffer).cast()
    }

    /// Direct buffer over memory of the library's; null where it is longer than such buffers are.
    pub(crate) fn buffer(self, bytes: *const u8, length: u64) -> jobject {
        let Ok(length) = jint::try_from(length) else {
            return null_mut();
        };
        call!(self, v1_4, NewDirectByteBuffer, bytes.cast_mut().cast(), jlong::from(length))
    }
}

/// Bytes of a text of C, without the zero.
///
/// # Safety
/// `text` is zero-terminated, and stays for the call.
pub(crate) unsafe fn text_bytes<'t>(text: *const c_char) -> &'t [u8] {
    // SAFETY: the caller's word.
    unsafe { CStr::from_ptr(text) }.to_bytes()
}

/// Calls what makes a handle, and writes the handle to an array.
///
/// # Safety
/// As the crate says.
pub(crate) unsafe fn made<T>(
    env: *mut JNIEnv,
    handle_out: jlongArray,
    make: impl FnOnce(*mut *mut T) -> SubsurfStatus,
) -> jint {
    let mut made = null_mut();
    let status = make(&raw mut made);
    if status == SubsurfStatus::Ok {
        // SAFETY: the caller's word.
        unsafe { Env::new(env) }.set_longs(handle_out, &[handle(made)]);
    }
    status as jint
}

/// Calls what finds numbers, and writes them to an array.
///
/// # Safety
/// As the crate says.
pub(crate) unsafe fn found<const N: usize>(
    env: *mut JNIEnv,
    numbers_out: jfloatArray,
    find: impl FnOnce(&mut [f32; N]) -> SubsurfStatus,
) -> jint {
    let mut numbers = [0.0; N];
    let status = find(&mut numbers);
    if status == SubsurfStatus::Ok {
        // SAFETY: the caller's word.
        unsafe { Env::new(env) }.set_floats(numbers_out, &numbers);
    }
    status as jint
}
