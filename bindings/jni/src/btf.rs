//! BTFs: their description and values.

use jni_sys::{JNIEnv, jbyteArray, jclass, jfloat, jfloatArray, jint, jintArray, jlong, jlongArray};
use subsurf_c::{
    SubsurfBtfInfo, SubsurfBtfMaterial, SubsurfFile, SubsurfStatus, subsurf_btf_albedo, subsurf_btf_eval,
    subsurf_btf_expand, subsurf_btf_info, subsurf_btf_linear, subsurf_btf_material, subsurf_btf_pdf,
    subsurf_btf_sample, subsurf_btf_texel,
};

use crate::convert::{int, long, pointer, unsigned};
use crate::env::{Env, text_bytes};
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

/// Writes three numbers that a function of C finds.
///
/// # Safety
/// As the crate says.
unsafe fn three(env: *mut JNIEnv, out: jfloatArray, find: impl FnOnce(*mut f32) -> SubsurfStatus) -> jint {
    let mut found = [0.0; 3];
    let status = find(found.as_mut_ptr());
    if status == SubsurfStatus::Ok {
        // SAFETY: the caller's word.
        unsafe { Env::new(env) }.set_floats(out, &found);
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
    let eval = |value| {
        let file = pointer::<SubsurfFile>(file);
        // SAFETY: an open handle, and three numbers each.
        unsafe { subsurf_btf_eval(file, unsigned(texel), light.as_ptr(), view.as_ptr(), value) }
    };
    // SAFETY: as the crate says.
    unsafe { three(env, value_out, eval) }
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
    unsafe { three(env, rgb_out, |rgb| subsurf_btf_linear(pointer(file), value.as_ptr(), rgb)) }
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
    let (mut light, mut pdf) = ([0.0; 3], 0.0);
    let (light_to, pdf_to) = (light.as_mut_ptr(), &raw mut pdf);
    let file = pointer::<SubsurfFile>(file);
    // SAFETY: an open handle, and numbers of this function's.
    let status = unsafe { subsurf_btf_sample(file, unsigned(texel), view.as_ptr(), random.as_ptr(), light_to, pdf_to) };
    if status == SubsurfStatus::Ok {
        let [x, y, z] = light;
        // SAFETY: as the crate says.
        unsafe { Env::new(env) }.set_floats(light_and_pdf_out, &[x, y, z, pdf]);
    }
    status as jint
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
    let mut pdf = 0.0;
    let file = pointer::<SubsurfFile>(file);
    // SAFETY: an open handle, three numbers each, and one of this function's.
    let status = unsafe { subsurf_btf_pdf(file, unsigned(texel), light.as_ptr(), view.as_ptr(), &raw mut pdf) };
    if status == SubsurfStatus::Ok {
        // SAFETY: as the crate says.
        unsafe { Env::new(env) }.set_floats(pdf_out, &[pdf]);
    }
    status as jint
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
    let find = |albedo| {
        // SAFETY: an open handle, and three numbers each.
        unsafe { subsurf_btf_albedo(pointer::<SubsurfFile>(file), unsigned(texel), view.as_ptr(), albedo) }
    };
    // SAFETY: as the crate says.
    unsafe { three(env, albedo_out, find) }
}
