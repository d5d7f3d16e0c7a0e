//! Files: opened, described, closed; and the text of errors.

use core::mem::MaybeUninit;

use jni_sys::{JNIEnv, jbyteArray, jclass, jint, jlong, jlongArray, jobject};
use subsurf_c::{
    SubsurfFileInfo, SubsurfStatus, subsurf_abi_version, subsurf_file_close, subsurf_file_info, subsurf_file_open_fd,
    subsurf_file_open_memory, subsurf_file_open_path, subsurf_last_error,
};

use crate::convert::{long, pointer, struct_size};
use crate::env::{Env, made, text_bytes};

/// Struct of C that a function fills: its size, and zeros, which are values of all fields.
///
/// # Safety
/// `T` is such a struct.
pub(crate) unsafe fn to_fill<T>() -> T {
    let mut value = MaybeUninit::<T>::zeroed();
    // SAFETY: structs of subsurf.h begin with their size, and zero is a value of each of their fields.
    unsafe {
        value.as_mut_ptr().cast::<u32>().write(struct_size::<T>());
        value.assume_init()
    }
}

#[unsafe(no_mangle)]
extern "system" fn Java_dev_subsurf_Native_abiVersion(_: *mut JNIEnv, _: jclass) -> jint {
    subsurf_abi_version().cast_signed()
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_lastError(env: *mut JNIEnv, _: jclass) -> jbyteArray {
    // SAFETY: as the crate says; the text stays until the next failure of this thread.
    unsafe { Env::new(env).bytes(text_bytes(subsurf_last_error())) }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_fileOpenPath(
    env: *mut JNIEnv,
    _: jclass,
    path: jbyteArray,
    file_out: jlongArray,
) -> jint {
    // SAFETY: as the crate says.
    unsafe { Env::new(env) }.with_text(path, |path| {
        // SAFETY: zero-terminated, and there for the call.
        unsafe { made(env, file_out, |file| subsurf_file_open_path(path, file)) }
    })
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_fileOpenFd(
    env: *mut JNIEnv,
    _: jclass,
    fd: jint,
    offset: jlong,
    length: jlong,
    file_out: jlongArray,
) -> jint {
    // A length of -1 is SUBSURF_TO_END.
    let [offset, length] = [offset, length].map(jlong::cast_unsigned);
    // SAFETY: as the crate says.
    unsafe { made(env, file_out, |file| subsurf_file_open_fd(fd, offset, length, file)) }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_fileOpenMemory(
    env: *mut JNIEnv,
    _: jclass,
    buffer: jobject,
    offset: jint,
    length: jint,
    file_out: jlongArray,
) -> jint {
    let (Ok(offset), Ok(length)) = (usize::try_from(offset), usize::try_from(length)) else {
        return SubsurfStatus::InvalidArgument as jint;
    };
    // SAFETY: as the crate says; Kotlin keeps the buffer, whose limits it has looked at.
    unsafe {
        let bytes = Env::new(env).address(buffer).wrapping_add(offset);
        made(env, file_out, |file| subsurf_file_open_memory(bytes.cast_const().cast(), length, file))
    }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_fileClose(_: *mut JNIEnv, _: jclass, file: jlong) {
    // SAFETY: Kotlin gives the handle up.
    unsafe { subsurf_file_close(pointer(file)) };
}

/// Family and bytes.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_fileInfo(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    longs: jlongArray,
) -> jint {
    // SAFETY: as the crate says.
    let (env, mut info) = unsafe { (Env::new(env), to_fill::<SubsurfFileInfo>()) };
    // SAFETY: an open handle, and a struct of this function's.
    let status = unsafe { subsurf_file_info(pointer(file), &raw mut info) };
    if status == SubsurfStatus::Ok {
        env.set_longs(longs, &[jlong::from(info.family as u32), long(info.file_bytes)]);
    }
    status as jint
}
