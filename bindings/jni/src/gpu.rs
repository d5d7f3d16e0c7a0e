//! Devices: opened, described, closed.

use core::ptr::null_mut;

use jni_sys::{JNIEnv, jbyteArray, jclass, jint, jintArray, jlong, jlongArray};
use subsurf_c::SubsurfStatus;
use subsurf_c_draw::{
    SubsurfGpuInfo, SubsurfGpuMemory, SubsurfGpuOptions, subsurf_gpu_close, subsurf_gpu_finish, subsurf_gpu_info,
    subsurf_gpu_lose, subsurf_gpu_memory, subsurf_gpu_open,
};

use crate::convert::{int, long, pointer, struct_size, unsigned};
use crate::env::{Env, made, text_bytes};
use crate::file::to_fill;

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_gpuOpen(
    env: *mut JNIEnv,
    _: jclass,
    backend: jint,
    window_system: jint,
    gpu_out: jlongArray,
) -> jint {
    let options = SubsurfGpuOptions {
        struct_size: struct_size::<SubsurfGpuOptions>(),
        backend: unsigned(backend),
        window_system: unsigned(window_system),
        display: null_mut(),
    };
    // SAFETY: as the crate says; options and handle are this function's.
    unsafe { made(env, gpu_out, |gpu| subsurf_gpu_open(&raw const options, gpu)) }
}

/// Names of device and driver as UTF-8, with a zero between them, and backend, is_software, draws_half_floats, most_texels, and
/// the status, written last; null where it is not 0.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_gpuInfo(
    env: *mut JNIEnv,
    _: jclass,
    gpu: jlong,
    ints: jintArray,
) -> jbyteArray {
    // SAFETY: as the crate says.
    let (env, mut info) = unsafe { (Env::new(env), to_fill::<SubsurfGpuInfo>()) };
    // SAFETY: an open handle, and a struct of this function's.
    let status = unsafe { subsurf_gpu_info(pointer(gpu), &raw mut info) };
    let numbers = [info.backend as u32, info.is_software, info.draws_half_floats, info.most_texels];
    let [backend, is_software, draws_half_floats, most_texels] = numbers.map(int);
    env.set_ints(ints, &[backend, is_software, draws_half_floats, most_texels, status as jint]);
    if status != SubsurfStatus::Ok {
        return null_mut();
    }
    // SAFETY: both are zero-terminated.
    let [device, driver] = unsafe { [text_bytes(info.device.as_ptr()), text_bytes(info.driver.as_ptr())] };
    env.bytes(&[device, &[0], driver].concat())
}

/// Bytes of materials, meshes, views of lights, frames, and others.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_gpuMemory(
    env: *mut JNIEnv,
    _: jclass,
    gpu: jlong,
    longs: jlongArray,
) -> jint {
    // SAFETY: as the crate says.
    let (env, mut memory) = unsafe { (Env::new(env), to_fill::<SubsurfGpuMemory>()) };
    // SAFETY: an open handle, and a struct of this function's.
    let status = unsafe { subsurf_gpu_memory(pointer(gpu), &raw mut memory) };
    if status == SubsurfStatus::Ok {
        let SubsurfGpuMemory { materials_bytes, meshes_bytes, light_views_bytes, frames_bytes, others_bytes, .. } =
            memory;
        let bytes = [materials_bytes, meshes_bytes, light_views_bytes, frames_bytes, others_bytes];
        env.set_longs(longs, &bytes.map(long));
    }
    status as jint
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_gpuFinish(_: *mut JNIEnv, _: jclass, gpu: jlong) -> jint {
    // SAFETY: an open handle.
    unsafe { subsurf_gpu_finish(pointer(gpu)) as jint }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_gpuLose(_: *mut JNIEnv, _: jclass, gpu: jlong) -> jint {
    // SAFETY: an open handle.
    unsafe { subsurf_gpu_lose(pointer(gpu)) as jint }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_gpuClose(_: *mut JNIEnv, _: jclass, gpu: jlong) {
    // SAFETY: Kotlin gives the handle up.
    unsafe { subsurf_gpu_close(pointer(gpu)) };
}
