//! BTFs: their description and values.

use jni_sys::{JNIEnv, jbyteArray, jclass, jfloat, jfloatArray, jint, jintArray, jlong, jlongArray};
use subsurf_c::{
    SubsurfBtfInfo, SubsurfBtfMaterial, SubsurfStatus, subsurf_btf_albedo, subsurf_btf_eval, subsurf_btf_expand,
    subsurf_btf_info, subsurf_btf_linear, subsurf_btf_material, subsurf_btf_pdf, subsurf_btf_sample, subsurf_btf_texel,
};

use crate::convert::{int, long, pointer, unsigned};
use crate::env::{Env, found, text_bytes};
use crate::file::to_fill;

/// Seven whole numbers and four others, in the order of `SubsurfBtfInfo`, and the bytes of an expansion.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_btfInfo(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    ints: jintArray,
    floats: jfloatArray,
    expansion_out: jlongArray,
) -> jint {
    // SAFETY: as the crate says.
    let (env, mut info) = unsafe { (Env::new(env), to_fill::<SubsurfBtfInfo>()) };
    // SAFETY: an open handle, and a struct of this function's.
    let status = unsafe { subsurf_btf_info(pointer(file), &raw mut info) };
    if status == SubsurfStatus::Ok {
        let grid = [info.n_alpha, info.n_beta, info.n_theta, info.n_phi];
        let [n_alpha, n_beta, n_theta, n_phi] = grid.map(int);
        let [materials, texels, is_display] = [info.materials, info.texels, info.is_display].map(int);
        env.set_ints(ints, &[materials, texels, is_display, n_alpha, n_beta, n_theta, n_phi]);
        env.set_floats(floats, &[info.alpha_max, info.sin_beta_max, info.theta_max, info.cos_light_min]);
        env.set_longs(expansion_out, &[long(info.expansion_bytes)]);
    }
    status as jint
}

/// Name of a material as UTF-8, and width, height, levels, and the status, written last; null where it is not 0.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_btfMaterial(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    number: jint,
    ints: jintArray,
) -> jbyteArray {
    // SAFETY: as the crate says.
    let (env, mut material) = unsafe { (Env::new(env), to_fill::<SubsurfBtfMaterial>()) };
    // SAFETY: an open handle, and a struct of this function's.
    let status = unsafe { subsurf_btf_material(pointer(file), unsigned(number), &raw mut material) };
    let [width, height, levels] = [material.width, material.height, material.levels].map(int);
    env.set_ints(ints, &[width, height, levels, status as jint]);
    if status != SubsurfStatus::Ok {
        return core::ptr::null_mut();
    }
    // SAFETY: names are shorter than their room, and zeros follow.
    env.bytes(unsafe { text_bytes(material.name.as_ptr()) })
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_btfExpand(_: *mut JNIEnv, _: jclass, file: jlong) -> jint {
    // SAFETY: an open handle, which nothing else uses meanwhile.
    unsafe { subsurf_btf_expand(pointer(file)) as jint }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_btfTexel(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    material: jint,
    level: jint,
    x: jint,
    y: jint,
    texel_out: jintArray,
) -> jint {
    let mut texel = 0;
    let [material, level] = [material, level].map(unsigned);
    // SAFETY: an open handle, and a number of this function's.
    let status = unsafe { subsurf_btf_texel(pointer(file), material, level, x, y, &raw mut texel) };
    if status == SubsurfStatus::Ok {
        // SAFETY: as the crate says.
        unsafe { Env::new(env) }.set_ints(texel_out, &[int(texel)]);
    }
    status as jint
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_btfEval(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    texel: jint,
    light_x: jfloat,
    light_y: jfloat,
    light_z: jfloat,
    view_x: jfloat,
    view_y: jfloat,
    view_z: jfloat,
    value_out: jfloatArray,
) -> jint {
    let (light, view) = ([light_x, light_y, light_z], [view_x, view_y, view_z]);
    // SAFETY: an open handle, and three numbers each; as the crate says.
    unsafe {
        found(env, value_out, |value: &mut [f32; 3]| {
            subsurf_btf_eval(pointer(file), unsigned(texel), light.as_ptr(), view.as_ptr(), value.as_mut_ptr())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_btfLinear(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    red: jfloat,
    green: jfloat,
    blue: jfloat,
    rgb_out: jfloatArray,
) -> jint {
    let value = [red, green, blue];
    // SAFETY: an open handle, and three numbers each; as the crate says.
    unsafe {
        found(env, rgb_out, |rgb: &mut [f32; 3]| subsurf_btf_linear(pointer(file), value.as_ptr(), rgb.as_mut_ptr()))
    }
}

/// The light, and its density.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_btfSample(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    texel: jint,
    view_x: jfloat,
    view_y: jfloat,
    view_z: jfloat,
    random_0: jfloat,
    random_1: jfloat,
    light_and_pdf_out: jfloatArray,
) -> jint {
    let (view, random) = ([view_x, view_y, view_z], [random_0, random_1]);
    // SAFETY: an open handle, two numbers, three each, and one; as the crate says.
    unsafe {
        found(env, light_and_pdf_out, |out: &mut [f32; 4]| {
            let [x, y, z, pdf] = out;
            let mut light = [0.0; 3];
            let (file, light_to) = (pointer(file), light.as_mut_ptr());
            let status = subsurf_btf_sample(file, unsigned(texel), view.as_ptr(), random.as_ptr(), light_to, pdf);
            [*x, *y, *z] = light;
            status
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_btfPdf(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    texel: jint,
    light_x: jfloat,
    light_y: jfloat,
    light_z: jfloat,
    view_x: jfloat,
    view_y: jfloat,
    view_z: jfloat,
    pdf_out: jfloatArray,
) -> jint {
    let (light, view) = ([light_x, light_y, light_z], [view_x, view_y, view_z]);
    // SAFETY: an open handle, three numbers each, and one; as the crate says.
    unsafe {
        found(env, pdf_out, |[pdf]: &mut [f32; 1]| {
            subsurf_btf_pdf(pointer(file), unsigned(texel), light.as_ptr(), view.as_ptr(), pdf)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_btfAlbedo(
    env: *mut JNIEnv,
    _: jclass,
    file: jlong,
    texel: jint,
    view_x: jfloat,
    view_y: jfloat,
    view_z: jfloat,
    albedo_out: jfloatArray,
) -> jint {
    let view = [view_x, view_y, view_z];
    // SAFETY: an open handle, and three numbers each; as the crate says.
    unsafe {
        found(env, albedo_out, |albedo: &mut [f32; 3]| {
            subsurf_btf_albedo(pointer(file), unsigned(texel), view.as_ptr(), albedo.as_mut_ptr())
        })
    }
}
