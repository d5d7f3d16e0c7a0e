//! Renderers, and the pictures that they draw.

use jni_sys::{JNIEnv, jclass, jfloat, jfloatArray, jint, jlong, jlongArray, jobject};
use subsurf_c::SubsurfStatus;
use subsurf_c_draw::{
    SubsurfFrame, SubsurfFrameReport, SubsurfRenderer, SubsurfRendererOptions, subsurf_frame_look_at,
    subsurf_picture_close, subsurf_picture_create, subsurf_picture_read, subsurf_renderer_close,
    subsurf_renderer_create, subsurf_renderer_draw_picture, subsurf_renderer_draw_surface, subsurf_renderer_trim,
};

use crate::convert::{long, pointer, struct_size, unsigned};
use crate::env::{Env, made};
use crate::file::to_fill;
use crate::frame::Frame;

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_rendererCreate(
    env: *mut JNIEnv,
    _: jclass,
    gpu: jlong,
    samples: jint,
    budget_bytes: jlong,
    renderer_out: jlongArray,
) -> jint {
    let options = SubsurfRendererOptions {
        struct_size: struct_size::<SubsurfRendererOptions>(),
        samples: unsigned(samples),
        light_texels: 0,
        objects: 0,
        budget_bytes: budget_bytes.cast_unsigned(),
    };
    // SAFETY: as the crate says.
    unsafe { made(env, renderer_out, |out| subsurf_renderer_create(pointer(gpu), &raw const options, out)) }
}

/// Draws a frame, and writes the ns of pipelines, preparation, recording and of all until the device has done it, if anyone wants them.
///
/// # Safety
/// As the crate says.
unsafe fn draw(
    env: *mut JNIEnv,
    [numbers, handles]: [jobject; 2],
    report_out: jlongArray,
    draw: impl FnOnce(*const SubsurfFrame, *mut SubsurfFrameReport) -> SubsurfStatus,
) -> jint {
    // SAFETY: the caller's word.
    let (env, mut report) = unsafe { (Env::new(env), to_fill::<SubsurfFrameReport>()) };
    let frame = Frame::new(&env.floats(numbers), &env.longs(handles));
    let report_to = if report_out.is_null() { core::ptr::null_mut() } else { &raw mut report };
    let status = frame.with(|frame| draw(frame, report_to));
    if status == SubsurfStatus::Ok && !report_out.is_null() {
        let SubsurfFrameReport { pipelines_ns, prepare_ns, recording_ns, done_ns, .. } = report;
        env.set_longs(report_out, &[pipelines_ns, prepare_ns, recording_ns, done_ns].map(long));
    }
    status as jint
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_drawPicture(
    env: *mut JNIEnv,
    _: jclass,
    renderer: jlong,
    picture: jlong,
    numbers: jfloatArray,
    handles: jlongArray,
    report_out: jlongArray,
) -> jint {
    let renderer = pointer::<SubsurfRenderer>(renderer);
    // SAFETY: open handles, used by one thread.
    let to = |frame, report| unsafe { subsurf_renderer_draw_picture(renderer, frame, pointer(picture), report) };
    // SAFETY: as the crate says.
    unsafe { draw(env, [numbers, handles], report_out, to) }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_drawSurface(
    env: *mut JNIEnv,
    _: jclass,
    renderer: jlong,
    surface: jlong,
    numbers: jfloatArray,
    handles: jlongArray,
    report_out: jlongArray,
) -> jint {
    let renderer = pointer::<SubsurfRenderer>(renderer);
    // SAFETY: open handles, used by one thread.
    let to = |frame, report| unsafe { subsurf_renderer_draw_surface(renderer, frame, pointer(surface), report) };
    // SAFETY: as the crate says.
    unsafe { draw(env, [numbers, handles], report_out, to) }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_rendererTrim(_: *mut JNIEnv, _: jclass, renderer: jlong) -> jint {
    // SAFETY: an open handle, used by one thread.
    unsafe { subsurf_renderer_trim(pointer(renderer)) as jint }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_rendererClose(_: *mut JNIEnv, _: jclass, renderer: jlong) {
    // SAFETY: Kotlin gives the handle up.
    unsafe { subsurf_renderer_close(pointer(renderer)) };
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_pictureCreate(
    env: *mut JNIEnv,
    _: jclass,
    gpu: jlong,
    width: jint,
    height: jint,
    picture_out: jlongArray,
) -> jint {
    let [width, height] = [width, height].map(unsigned);
    // SAFETY: as the crate says.
    unsafe { made(env, picture_out, |out| subsurf_picture_create(pointer(gpu), width, height, out)) }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_pictureRead(
    env: *mut JNIEnv,
    _: jclass,
    picture: jlong,
    pixels: jobject,
    length: jint,
) -> jint {
    // SAFETY: as the crate says.
    let pixels = unsafe { Env::new(env) }.address(pixels);
    let Ok(length) = usize::try_from(length) else { return SubsurfStatus::InvalidArgument as jint };
    // SAFETY: an open handle, and a buffer whose length Kotlin has looked at.
    unsafe { subsurf_picture_read(pointer(picture), pixels.cast(), length, 0) as jint }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_pictureClose(_: *mut JNIEnv, _: jclass, picture: jlong) {
    // SAFETY: Kotlin gives the handle up.
    unsafe { subsurf_picture_close(pointer(picture)) };
}

/// Both matrices, 16 numbers each, of a camera: `numbers` has the eye, what it looks at, angle, aspect, and the nearest and
/// furthest distance.
#[unsafe(no_mangle)]
unsafe extern "system" fn Java_dev_subsurf_Native_frameLookAt(
    env: *mut JNIEnv,
    _: jclass,
    numbers: jfloatArray,
    matrices_out: jfloatArray,
) -> jint {
    // SAFETY: as the crate says.
    let env = unsafe { Env::new(env) };
    let numbers = env.floats(numbers);
    let [ex, ey, ez, tx, ty, tz, fov_y, aspect, near, far] = *numbers.as_slice() else {
        return SubsurfStatus::InvalidArgument as jint;
    };
    let (eye, target): ([jfloat; 3], [jfloat; 3]) = ([ex, ey, ez], [tx, ty, tz]);
    // SAFETY: as the crate says.
    let mut frame = unsafe { to_fill::<SubsurfFrame>() };
    // SAFETY: numbers and a struct of this function's.
    let status =
        unsafe { subsurf_frame_look_at(&raw mut frame, eye.as_ptr(), target.as_ptr(), fov_y, aspect, near, far) };
    if status == SubsurfStatus::Ok {
        env.set_floats(matrices_out, [frame.view_from_world, frame.clip_from_view].as_flattened());
    }
    status as jint
}
