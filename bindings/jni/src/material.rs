//! Materials, meshes and surroundings on a device.

use core::ptr::null;

use jni_sys::{JNIEnv, jclass, jfloat, jfloatArray, jint, jintArray, jlong, jlongArray, jobject};
use subsurf_c::SubsurfStatus;
use subsurf_c_draw::{
    SubsurfLoadReport, SubsurfMaterialInfo, SubsurfMaterialOptions, SubsurfMeshData, SubsurfMeshInfo,
    subsurf_environment_close, subsurf_environment_studio, subsurf_environment_uniform, subsurf_material_close,
    subsurf_material_info, subsurf_material_load, subsurf_mesh_close, subsurf_mesh_info, subsurf_mesh_shape,
    subsurf_mesh_upload,
};

use crate::convert::{int, long, pointer, struct_size, unsigned};
use crate::env::{Env, made};
use crate::file::to_fill;

/// Bytes of the file and on the device, and ns of upload, pipelines, recording and projection.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_materialLoad(
    env: *mut JNIEnv,
    _: jclass,
    gpu: jlong,
    file: jlong,
    technique: jint,
    report_out: jlongArray,
    material_out: jlongArray,
) -> jint {
    let options =
        SubsurfMaterialOptions { struct_size: struct_size::<SubsurfMaterialOptions>(), technique: unsigned(technique) };
    // SAFETY: as the crate says.
    let mut report = unsafe { to_fill::<SubsurfLoadReport>() };
    let report_to = &raw mut report;
    // SAFETY: open handles; options, report and handle are this function's.
    let load = |out| unsafe {
        subsurf_material_load(pointer(gpu), pointer::<subsurf_c::SubsurfFile>(file), &raw const options, report_to, out)
    };
    // SAFETY: as the crate says.
    let status = unsafe { made(env, material_out, load) };
    if status == SubsurfStatus::Ok as jint {
        let SubsurfLoadReport { file_bytes, gpu_bytes, upload_ns, pipelines_ns, recording_ns, projection_ns, .. } =
            report;
        let numbers = [file_bytes, gpu_bytes, upload_ns, pipelines_ns, recording_ns, projection_ns];
        // SAFETY: as the crate says.
        unsafe { Env::new(env) }.set_longs(report_out, &numbers.map(long));
    }
    status
}

/// Technique, and bytes on the device.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_materialInfo(
    env: *mut JNIEnv,
    _: jclass,
    material: jlong,
    longs: jlongArray,
) -> jint {
    // SAFETY: as the crate says.
    let (env, mut info) = unsafe { (Env::new(env), to_fill::<SubsurfMaterialInfo>()) };
    // SAFETY: an open handle, and a struct of this function's.
    let status = unsafe { subsurf_material_info(pointer(material), &raw mut info) };
    if status == SubsurfStatus::Ok {
        env.set_longs(longs, &[jlong::from(info.technique as u32), long(info.gpu_bytes)]);
    }
    status as jint
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_materialClose(_: *mut JNIEnv, _: jclass, material: jlong) {
    // SAFETY: Kotlin gives the handle up.
    unsafe { subsurf_material_close(pointer(material)) };
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_meshUpload(
    env: *mut JNIEnv,
    _: jclass,
    gpu: jlong,
    vertices: jint,
    triangles: jint,
    positions: jobject,
    normals: jobject,
    uvs: jobject,
    indices: jobject,
    mesh_out: jlongArray,
) -> jint {
    // SAFETY: as the crate says.
    let buffers = unsafe { Env::new(env) };
    let floats = |buffer: jobject| if buffer.is_null() { null() } else { buffers.address(buffer).cast_const().cast() };
    let data = SubsurfMeshData {
        struct_size: struct_size::<SubsurfMeshData>(),
        vertices: unsigned(vertices),
        triangles: unsigned(triangles),
        mm_per_unit: 1.0,
        positions: floats(positions),
        normals: floats(normals),
        uvs: floats(uvs),
        indices: buffers.address(indices).cast_const().cast(),
    };
    // SAFETY: an open handle, and buffers whose lengths Kotlin has looked at.
    unsafe { made(env, mesh_out, |mesh| subsurf_mesh_upload(pointer(gpu), &raw const data, mesh)) }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_meshShape(
    env: *mut JNIEnv,
    _: jclass,
    gpu: jlong,
    shape: jint,
    extent_mm: jfloat,
    mesh_out: jlongArray,
) -> jint {
    // SAFETY: as the crate says.
    unsafe { made(env, mesh_out, |mesh| subsurf_mesh_shape(pointer(gpu), unsigned(shape), extent_mm, mesh)) }
}

/// Vertices, triangles and has_uvs; centre and radius of what holds it; bytes on the device.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_meshInfo(
    env: *mut JNIEnv,
    _: jclass,
    mesh: jlong,
    ints: jintArray,
    floats: jfloatArray,
    bytes_out: jlongArray,
) -> jint {
    // SAFETY: as the crate says.
    let (env, mut info) = unsafe { (Env::new(env), to_fill::<SubsurfMeshInfo>()) };
    // SAFETY: an open handle, and a struct of this function's.
    let status = unsafe { subsurf_mesh_info(pointer(mesh), &raw mut info) };
    if status == SubsurfStatus::Ok {
        let [x, y, z] = info.centre_mm;
        env.set_ints(ints, &[info.vertices, info.triangles, info.has_uvs].map(int));
        env.set_floats(floats, &[x, y, z, info.radius_mm]);
        env.set_longs(bytes_out, &[long(info.gpu_bytes)]);
    }
    status as jint
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_meshClose(_: *mut JNIEnv, _: jclass, mesh: jlong) {
    // SAFETY: Kotlin gives the handle up.
    unsafe { subsurf_mesh_close(pointer(mesh)) };
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_environmentUniform(
    env: *mut JNIEnv,
    _: jclass,
    red: jfloat,
    green: jfloat,
    blue: jfloat,
    environment_out: jlongArray,
) -> jint {
    let irradiance = [red, green, blue];
    // SAFETY: as the crate says.
    unsafe { made(env, environment_out, |out| subsurf_environment_uniform(irradiance.as_ptr(), out)) }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_environmentStudio(
    env: *mut JNIEnv,
    _: jclass,
    environment_out: jlongArray,
) -> jint {
    // SAFETY: as the crate says.
    unsafe { made(env, environment_out, |out| subsurf_environment_studio(out)) }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_environmentClose(_: *mut JNIEnv, _: jclass, environment: jlong) {
    // SAFETY: Kotlin gives the handle up.
    unsafe { subsurf_environment_close(pointer(environment)) };
}
