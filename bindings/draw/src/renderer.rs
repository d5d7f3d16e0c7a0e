//! Renderers: pipelines, and the room of the frames that they draw.

use std::mem::offset_of;
use std::sync::{Arc, Weak};
use std::time::{Duration, Instant};

use subsurf_c::SubsurfStatus;
use subsurf_c::shared::{Handle, Kind, Versioned, fill, not_null, write};
use subsurf_runtime::wgpu::{Color, LoadOp, TextureFormat};
use subsurf_runtime::{DepthTarget, Frame, Input, Object, Renderer, RuntimeOptions, Target};
use subsurf_scene::{Environment, Lighting};
use subsurf_shaders::cpu::linear;

use crate::canvas::Canvas;
use crate::fault::{Fault, Result, call};
use crate::frame::{Shown, SubsurfFrame};
use crate::gpu::{OpenGpu, SubsurfGpu, close};
use crate::input::{fillable, take};
use crate::material::nanoseconds;
use crate::picture::{OpenPicture, SubsurfPicture};
use crate::surface::{OpenSurface, SubsurfSurface};

/// Renderer: pipelines of techniques, and room for the frames of one size: depth, maps, what lights see.
///
/// Pipelines are compiled, and room is made, by the first frame that needs them; another size, material, shadow or distance of the camera
/// takes other room. Pictures and windows that are drawn in turns have a renderer each.
///
/// Ownership: `subsurf_renderer_create` gives one, `subsurf_renderer_close` takes it back; it keeps its device, and materials that it drew until
/// they are closed and another frame is drawn.
/// Threads: any, one at a time.
pub struct SubsurfRenderer {
    /// What is there is a [`Handle`] of [`OpenRenderer`].
    _opaque: [u8; 0],
}

/// How a renderer draws. Set `struct_size` to `sizeof(SubsurfRendererOptions)`; zeros are the usual choice.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfRendererOptions {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// Samples to a pixel, 1 or 4; 0 stands for 1.
    pub samples: u32,
    /// Texels to a side of what each light sees: a power of two, 128 or more; 0 stands for 512.
    pub light_texels: u32,
    /// Most objects of a frame, to 1,000,000; 0 stands for 16.
    pub objects: u32,
    /// Most bytes on the device, materials, meshes and pictures included; 0 for no limit. Frames become coarser until they fit.
    pub budget_bytes: u64,
}

/// What a frame took. Set `struct_size` to `sizeof(SubsurfFrameReport)` before it is filled.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfFrameReport {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// Nanoseconds of pipelines that the frame compiled: none but at the first of a technique.
    pub pipelines_ns: u64,
    /// Nanoseconds of making room: none but at the first of a size, or of materials.
    pub prepare_ns: u64,
    /// Nanoseconds of the processor for the frame itself.
    pub recording_ns: u64,
    /// Nanoseconds from the beginning of the call until the device has done the frame.
    pub done_ns: u64,
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfRendererOptions {
    const NAME: &'static str = "SubsurfRendererOptions";
    const FIRST_BYTES: usize = offset_of!(Self, budget_bytes) + size_of::<u64>();
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfFrameReport {
    const NAME: &'static str = "SubsurfFrameReport";
    const FIRST_BYTES: usize = offset_of!(Self, done_ns) + size_of::<u64>();
}

/// What is behind a handle.
pub(crate) struct OpenRenderer {
    gpu: OpenGpu,
    options: RuntimeOptions,
    /// Pipelines by the format that they draw to.
    by_format: Vec<(TextureFormat, Renderer)>,
    room: Option<Room>,
    dark: Environment,
}

impl Kind for Box<OpenRenderer> {
    const NAME: &'static str = "SubsurfRenderer";
    const WORD: u64 = 0x5ab5_0f11_e0be_0006;
}

/// What frames of one size take.
struct Room {
    format: TextureFormat,
    frame: Frame,
    depth: DepthTarget,
    /// Materials that it was made for.
    materials: Vec<Weak<()>>,
}

/// How long the parts of a frame took.
#[derive(Default)]
pub(crate) struct Times {
    pipelines: Duration,
    prepare: Duration,
    recording: Duration,
}

/// Result of some work, whose time is added to a part.
fn timed<T>(part: &mut Duration, work: impl FnOnce() -> T) -> T {
    let begin = Instant::now();
    let made = work();
    *part += begin.elapsed();
    made
}

impl OpenRenderer {
    /// Draws a frame in a submission of its own.
    fn draw(&mut self, shown: &Shown<'_>, canvas: &Canvas<'_>) -> Result<Times> {
        let Self { gpu, options, by_format, room, dark } = self;
        let mut times = Times::default();
        let renderer = timed(&mut times.pipelines, || compiled(gpu, options, by_format, shown, canvas.format));
        let renderer = gpu.told(renderer)?;
        let objects: Vec<Object<'_>> = shown.objects.iter().map(|object| object.object()).collect();
        let environment = shown.environment.map_or(&*dark, |environment| &environment.0);
        let lighting = Lighting { lights: &shown.lights, environment, reference_mm: shown.reference_mm };
        let input = Input { view: shown.view, exposure: shown.exposure, lighting, shadow_maps: &[], objects: &objects };
        let serves = |room: &Room| {
            let is_whole = room.format == canvas.format && room.materials.iter().all(|alive| alive.strong_count() > 0);
            Ok(is_whole && renderer.serves(&room.frame, &input, canvas.size)?)
        };
        if !gpu.told(room.as_ref().map_or(Ok(false), serves))? {
            // The old one goes first, for it counts in the budget.
            *room = None;
            let make = || {
                let depth = DepthTarget::new(&gpu.gpu, canvas.size, renderer.options())?;
                Ok(Room {
                    format: canvas.format,
                    frame: renderer.prepare(&gpu.gpu, &input, canvas.size)?,
                    depth,
                    materials: shown.objects.iter().map(|object| Arc::downgrade(&object.of.alive)).collect(),
                })
            };
            *room = Some(gpu.told(timed(&mut times.prepare, make))?);
        }
        if let Some(Room { frame, depth, .. }) = room {
            let load = LoadOp::Clear(background(shown.background, canvas.format));
            let target = Target { load, ..depth.with(canvas.view) };
            let draw = || renderer.draw_now(&gpu.gpu, frame, &input, &target);
            gpu.told(timed(&mut times.recording, draw))?;
        }
        Ok(times)
    }
}

/// Renderer for a format with the pipelines of all objects, compiled where they are not.
fn compiled<'r>(
    gpu: &OpenGpu,
    options: &RuntimeOptions,
    by_format: &'r mut Vec<(TextureFormat, Renderer)>,
    shown: &Shown<'_>,
    format: TextureFormat,
) -> subsurf_runtime::Result<&'r Renderer> {
    let known = by_format.iter().position(|(of, _)| *of == format);
    let number = match known {
        Some(number) => number,
        None => {
            by_format.push((format, Renderer::new(&gpu.gpu, RuntimeOptions { format, ..*options })?));
            by_format.len() - 1
        }
    };
    let renderer = &mut by_format[number].1;
    for object in &shown.objects {
        renderer.compile(&gpu.gpu, object.material.technique())?;
    }
    Ok(renderer)
}

/// Background for a target, which encodes linear values if its format is one of sRGB (IEC 61966-2-1).
fn background(display: [f32; 4], format: TextureFormat) -> Color {
    let [r, g, b, a] = display.map(|value| value.clamp(0.0, 1.0));
    let colour = if format.is_srgb() { linear([r, g, b]) } else { [r, g, b] };
    let [r, g, b] = colour.map(f64::from);
    Color { r, g, b, a: f64::from(a) }
}

/// Makes a renderer on a device: the passes that all techniques share.
///
/// `options`: null for the usual choice. `*renderer_out`: the handle; only written on success.
/// Errors: `INVALID_ARGUMENT`, `UNSUPPORTED`, `OUT_OF_MEMORY`, `DEVICE_LOST`, `DEVICE_FAILED`.
/// Ownership: the struct is not needed afterwards.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_renderer_create(
    gpu: *const SubsurfGpu,
    options: *const SubsurfRendererOptions,
    renderer_out: *mut *mut SubsurfRenderer,
) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle.
        let gpu = unsafe { OpenGpu::of(gpu) }?;
        not_null("renderer_out", renderer_out)?;
        let usual = SubsurfRendererOptions { struct_size: 0, samples: 0, light_texels: 0, objects: 0, budget_bytes: 0 };
        // SAFETY: the caller's struct, of numbers.
        let asked = if options.is_null() { usual } else { unsafe { take("options", options, usual) }? };
        if asked.objects > MOST_OBJECTS {
            return Err(Fault::invalid(format!("objects is {}, expected are {MOST_OBJECTS} at most", asked.objects)));
        }
        let or = |value: u32, usual: u32| if value == 0 { usual } else { value };
        let usual = RuntimeOptions::default();
        let options = RuntimeOptions {
            samples: or(asked.samples, usual.samples),
            light_texels: or(asked.light_texels, usual.light_texels),
            objects: or(asked.objects, usual.objects),
            budget_bytes: (asked.budget_bytes > 0).then_some(asked.budget_bytes),
            ..usual
        };
        // Options are checked, and what all techniques share is compiled, for the format of pictures, which most windows have too.
        gpu.told(gpu.gpu.expect_alive())?;
        let renderer = gpu.told(Renderer::new(&gpu.gpu, options))?;
        let by_format = vec![(options.format, renderer)];
        let dark = Environment::uniform([0.0; 3]);
        let handle = Handle::create(Box::new(OpenRenderer { gpu: gpu.clone(), options, by_format, room: None, dark }))?;
        // SAFETY: the caller's pointer, which is not null.
        Ok(unsafe { write("renderer_out", renderer_out, handle.as_ptr().cast()) }?)
    })
}

/// Most objects that a renderer may be asked to have room for.
const MOST_OBJECTS: u32 = 1_000_000;

/// Draws into a renderer's target, and tells how long it took.
///
/// # Safety
/// Pointers are null or as the header says.
unsafe fn draw(
    renderer: *mut SubsurfRenderer,
    frame: *const SubsurfFrame,
    report: *mut SubsurfFrameReport,
    onto: impl FnOnce(&OpenGpu, &mut dyn FnMut(&Canvas<'_>) -> Result<()>) -> Result<()>,
) -> SubsurfStatus {
    call(|| {
        let begin = Instant::now();
        // SAFETY: the caller's handle, which nothing else uses.
        let open = unsafe { Handle::<Box<OpenRenderer>>::of_mut("renderer", renderer.cast()) }?;
        let gpu = open.gpu.clone();
        // SAFETY: the caller's struct.
        unsafe { fillable("report", report.cast_const()) }?;
        // SAFETY: the caller's frame.
        let shown = unsafe { Shown::new(&gpu, frame, open.options.objects) }?;
        let mut times = Times::default();
        onto(&gpu, &mut |canvas| {
            times = open.draw(&shown, canvas)?;
            Ok(())
        })?;
        if report.is_null() {
            return Ok(());
        }
        gpu.told(gpu.gpu.finish())?;
        let value = SubsurfFrameReport {
            struct_size: 0,
            pipelines_ns: nanoseconds(times.pipelines),
            prepare_ns: nanoseconds(times.prepare),
            recording_ns: nanoseconds(times.recording),
            done_ns: nanoseconds(begin.elapsed()),
        };
        // SAFETY: the caller's struct.
        Ok(unsafe { fill("report", report, value) }?)
    })
}

/// Draws a frame into a picture.
///
/// `frame`: what it shows. `report`: filled as far as its `struct_size` reaches, after waiting for the device; null to wait for nothing.
/// Errors: `INVALID_ARGUMENT`, `INVALID_MESH` (it lacks texture coordinates that its material needs), `OVER_BUDGET`, `UNSUPPORTED`, `DEVICE_LOST`,
/// `DEVICE_FAILED`.
/// Ownership: everything stays the caller's, and may be closed as soon as the call returns.
/// Threads: any, one at a time for the renderer and for the picture.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_renderer_draw_picture(
    renderer: *mut SubsurfRenderer,
    frame: *const SubsurfFrame,
    picture: *const SubsurfPicture,
    report: *mut SubsurfFrameReport,
) -> SubsurfStatus {
    // SAFETY: the caller's pointers.
    unsafe {
        draw(renderer, frame, report, |gpu, draw| {
            let picture = OpenPicture::of(picture)?;
            picture.expect_on(gpu)?;
            draw(&picture.canvas())
        })
    }
}

/// Draws a frame into a window, and shows it: waits for the display where frames come faster.
///
/// `frame`: what it shows. `report`: filled as far as its `struct_size` reaches, after waiting for the device; null to wait for nothing.
/// Errors: those of `subsurf_renderer_draw_picture`; `SKIPPED` where the window takes no picture at present; `SURFACE_LOST`.
/// Ownership: everything stays the caller's, and may be closed as soon as the call returns.
/// Threads: any, one at a time for the renderer and for the surface.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_renderer_draw_surface(
    renderer: *mut SubsurfRenderer,
    frame: *const SubsurfFrame,
    surface: *mut SubsurfSurface,
    report: *mut SubsurfFrameReport,
) -> SubsurfStatus {
    // SAFETY: the caller's pointers.
    unsafe {
        draw(renderer, frame, report, |gpu, draw| {
            let surface = OpenSurface::of_mut(surface)?;
            surface.expect_on(gpu)?;
            surface.show(draw)
        })
    }
}

/// Gives up the room of a renderer, so that the device has it for others: the next frame makes it anew. For an app that goes into
/// the background or is told that memory is low.
///
/// Errors: `INVALID_ARGUMENT`.
/// Threads: any, one at a time for the renderer.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_renderer_trim(renderer: *mut SubsurfRenderer) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle, which nothing else uses.
        unsafe { Handle::<Box<OpenRenderer>>::of_mut("renderer", renderer.cast()) }?.room = None;
        Ok(())
    })
}

/// Closes a renderer. Null is ignored, and so is what is no handle.
///
/// Ownership: the handle is gone, and what it has on the device once it is drawn.
/// Threads: any, once no other uses the handle.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_renderer_close(renderer: *mut SubsurfRenderer) {
    close::<Box<OpenRenderer>, _>(renderer);
}
