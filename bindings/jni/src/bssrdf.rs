//! BSSRDFs: their description, planes and values.

use core::ptr::null_mut;

use jni_sys::{JNIEnv, jclass, jfloatArray, jint, jintArray, jlong, jlongArray, jobject};
use subsurf_c::{
    SubsurfBssrdfInfo, SubsurfPlane, SubsurfStatus, subsurf_bssrdf_albedo, subsurf_bssrdf_info, subsurf_bssrdf_plane,
    subsurf_bssrdf_rd,
};

use crate::convert::{int, long, pointer, unsigned};
use crate::env::{Env, found};
use crate::file::to_fill;

/// Ten whole numbers, and pitch, largest radius and refractive index, in the order of `SubsurfBssrdfInfo`.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_bssrdfInfo(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    ints: jintArray,
    floats: jfloatArray,
) -> jint {
    // SAFETY: as the crate says.
    let (env, mut info) = unsafe { (Env::new(env), to_fill::<SubsurfBssrdfInfo>()) };
    // SAFETY: an open handle, and a struct of this function's.
    let status = unsafe { subsurf_bssrdf_info(pointer(file), &raw mut info) };
    if status == SubsurfStatus::Ok {
        let numbers = [
            info.bases_per_pixel,
            info.coding as u32,
            info.addressing as u32,
            info.width,
            info.height,
            info.window_radius,
            info.samples,
            info.base_materials,
            info.bits_per_pixel,
            info.planes,
        ];
        env.set_ints(ints, &numbers.map(int));
        env.set_floats(floats, &[info.pitch_mm, info.r_max_mm, info.eta]);
    }
    status as jint
}

/// Bytes of a plane, and twelve numbers in the order of `SubsurfPlane`; null where the status, written last, is not 0.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_bssrdfPlane(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    number: jint,
    longs: jlongArray,
) -> jobject {
    // SAFETY: as the crate says.
    let (env, mut plane) = unsafe { (Env::new(env), to_fill::<SubsurfPlane>()) };
    // SAFETY: an open handle, and a struct of this function's.
    let status = unsafe { subsurf_bssrdf_plane(pointer(file), unsigned(number), &raw mut plane) };
    let small = [
        plane.kind as u32,
        plane.format as u32,
        plane.width,
        plane.height,
        plane.layers,
        plane.row_bytes,
        plane.gl_internal_format,
        plane.gl_format,
        plane.gl_type,
        plane.vk_format,
    ];
    let [kind, format, width, height, layers, row, gl_internal, gl_format, gl_type, vk] = small.map(jlong::from);
    let layer = long(plane.layer_bytes);
    let status_long = jlong::from(status as jint);
    let numbers = [kind, format, width, height, layers, row, gl_internal, gl_format, gl_type, vk, layer, status_long];
    env.set_longs(longs, &numbers);
    if status == SubsurfStatus::Ok { env.buffer(plane.data.cast(), plane.bytes) } else { null_mut() }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_bssrdfRd(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    x_i: jint,
    y_i: jint,
    x_o: jint,
    y_o: jint,
    rd_out: jfloatArray,
) -> jint {
    // SAFETY: an open handle, and three numbers; as the crate says.
    unsafe {
        found(env, rd_out, |rd: &mut [f32; 3]| subsurf_bssrdf_rd(pointer(file), x_i, y_i, x_o, y_o, rd.as_mut_ptr()))
    }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_bssrdfAlbedo(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    x: jint,
    y: jint,
    albedo_out: jfloatArray,
) -> jint {
    // SAFETY: an open handle, and three numbers; as the crate says.
    unsafe {
        found(env, albedo_out, |albedo: &mut [f32; 3]| subsurf_bssrdf_albedo(pointer(file), x, y, albedo.as_mut_ptr()))
    }
}
