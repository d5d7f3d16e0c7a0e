//! Surfaces of windows: Android's `Surface`.

use jni_sys::{JNIEnv, jclass, jint, jlong, jlongArray, jobject};
use subsurf_c_draw::{subsurf_surface_close, subsurf_surface_open, subsurf_surface_resize};

use crate::convert::{pointer, unsigned};
use crate::env::made;

/// Windows of Android: `android/native_window_jni.h`.
#[cfg(target_os = "android")]
mod window {
    use core::ffi::c_void;

    use jni_sys::{JNIEnv, jobject};

    #[link(name = "android")]
    unsafe extern "C" {
        fn ANativeWindow_fromSurface(env: *mut JNIEnv, surface: jobject) -> *mut c_void;
        fn ANativeWindow_release(window: *mut c_void);
    }

    /// Window of a `Surface`, with a reference of its own; null if it is gone.
    pub(super) unsafe fn acquire(env: *mut JNIEnv, surface: jobject) -> usize {
        // SAFETY: the caller's word.
        unsafe { ANativeWindow_fromSurface(env, surface) }.addr()
    }

    pub(super) unsafe fn release(window: usize) {
        if window != 0 {
            // SAFETY: the caller's word.
            unsafe { ANativeWindow_release(core::ptr::with_exposed_provenance_mut(window)) }
        }
    }
}

/// Where there is no such thing: a null window, which is refused with a text.
#[cfg(not(target_os = "android"))]
mod window {
    pub(super) unsafe fn acquire(_: *mut super::JNIEnv, _: super::jobject) -> usize {
        0
    }

    pub(super) unsafe fn release(_: usize) {}
}

/// Opens a surface on a `Surface`; two handles, of the surface and of its window.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_surfaceOpen(
    env: *mut JNIEnv,
    _: jclass,
    gpu: jlong,
    window: jobject,
    width: jint,
    height: jint,
    surface_and_window_out: jlongArray,
) -> jint {
    let [width, height] = [width, height].map(unsigned);
    // SAFETY: as the crate says.
    let window = unsafe { window::acquire(env, window) };
    let open = |out| {
        // SAFETY: an open handle, and a window that is there until the surface is closed.
        unsafe { subsurf_surface_open(pointer(gpu), window, width, height, out) }
    };
    // SAFETY: as the crate says.
    let status = unsafe { made(env, surface_and_window_out, open) };
    if status == 0 {
        // SAFETY: as the crate says.
        unsafe { crate::env::Env::new(env) }.set_longs_at(surface_and_window_out, 1, &[window.cast_signed() as jlong]);
    } else {
        // SAFETY: acquired above.
        unsafe { window::release(window) };
    }
    status
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_surfaceResize(
    _: *mut JNIEnv,
    _: jclass,
    surface: jlong,
    width: jint,
    height: jint,
) -> jint {
    let [width, height] = [width, height].map(unsigned);
    // SAFETY: an open handle, used by one thread.
    unsafe { subsurf_surface_resize(pointer(surface), width, height) as jint }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_surfaceClose(
    _: *mut JNIEnv,
    _: jclass,
    surface: jlong,
    window: jlong,
) {
    // SAFETY: Kotlin gives both up; the surface goes first.
    unsafe {
        subsurf_surface_close(pointer(surface));
        window::release(pointer::<()>(window).addr());
    }
}
