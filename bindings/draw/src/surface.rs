//! Surfaces: windows to draw to, which come and go while the device stays.

use subsurf_c::SubsurfStatus;
use subsurf_c::shared::{Handle, Kind, not_null, write};
use subsurf_runtime::wgpu::rwh::RawWindowHandle;
use subsurf_runtime::wgpu::{Surface, SurfaceTargetUnsafe, TextureViewDescriptor};
use subsurf_runtime::{Error, Screen};

use crate::canvas::Canvas;
use crate::fault::{Fault, Result, call, one_line};
use crate::gpu::{OpenGpu, SharedGpu, SubsurfGpu, close};
use crate::window::Display;

/// Window to draw to. An app on Android closes it when it is paused or its surface is destroyed, before that call returns, and opens another
/// when it comes back; device, materials, meshes and renderers stay.
///
/// Ownership: `subsurf_surface_open` gives one, `subsurf_surface_close` takes it back; it keeps its device.
/// Threads: any, one at a time.
pub struct SubsurfSurface {
    /// What is there is a [`Handle`] of [`OpenSurface`].
    _opaque: [u8; 0],
}

/// What is behind a handle.
pub(crate) struct OpenSurface {
    // Goes before the device, whose entry to the API made it.
    screen: Screen<'static>,
    display: Display,
    window: RawWindowHandle,
    gpu: OpenGpu,
}

impl Kind for OpenSurface {
    const NAME: &'static str = "SubsurfSurface";
    const WORD: u64 = 0x5ab5_0f11_e0be_0008;
}

/// Surface of a window.
///
/// # Safety
/// Display and window are there, and stay until the surface is dropped.
unsafe fn surface_of(
    gpu: &SharedGpu,
    display: &Display,
    window: RawWindowHandle,
) -> subsurf_runtime::Result<Surface<'static>> {
    let target = SurfaceTargetUnsafe::RawHandle { raw_display_handle: Some(display.raw()), raw_window_handle: window };
    // SAFETY: the caller's word.
    let surface = unsafe { gpu.instance.create_surface_unsafe(target) };
    surface.map_err(|error| Error::Surface(one_line(&error.to_string())))
}

impl OpenSurface {
    /// The surface behind a handle.
    ///
    /// # Safety
    /// As [`Handle::of_mut`] says.
    pub(crate) unsafe fn of_mut<'s>(surface: *mut SubsurfSurface) -> Result<&'s mut Self> {
        // SAFETY: the caller's word; what is there is such a handle.
        Ok(unsafe { Handle::<Self>::of_mut("surface", surface.cast()) }?)
    }

    /// Refuses a renderer of another device.
    pub(crate) fn expect_on(&self, gpu: &OpenGpu) -> Result<()> {
        let other = || Fault::invalid("the surface is on another SubsurfGpu than the renderer".to_owned());
        self.gpu.is(gpu).then_some(()).ok_or_else(other)
    }

    /// Draws into the texture that the window shows next, and shows it.
    pub(crate) fn show(&mut self, draw: &mut dyn FnMut(&Canvas<'_>) -> Result<()>) -> Result<()> {
        let Self { screen, display, window, gpu } = self;
        // SAFETY: the caller of subsurf_surface_open keeps display and window.
        let recreate = || unsafe { surface_of(gpu, display, *window) };
        let skipped = || {
            let text = "the window takes no picture at present: try again later".to_owned();
            Fault::Told(SubsurfStatus::Skipped, text)
        };
        gpu.told(gpu.gpu.expect_alive())?;
        let texture = gpu.told(screen.texture(&gpu.gpu, &gpu.adapter, recreate))?.ok_or_else(skipped)?;
        let view = texture.texture.create_view(&TextureViewDescriptor::default());
        draw(&Canvas { view: &view, format: screen.format(), size: screen.size() })?;
        gpu.gpu.queue().present(texture);
        gpu.told(Ok(()))
    }
}

/// Opens the surface of a window, in the window system that the device was opened for.
///
/// `window`: `ANativeWindow *` of Android, `Window` of X11, `wl_surface *` of Wayland. `width`, `height`: its pixels; 0 stands for 1.
/// `*surface_out`: the handle; only written on success.
/// Errors: `INVALID_ARGUMENT` (null; the device was opened for no window system), `UNSUPPORTED` (the device does not draw to the window, or not
/// in that size), `SURFACE_LOST` (there is no such window any more, or it takes no pictures of 8 bits), `DEVICE_LOST`, `DEVICE_FAILED`.
/// Ownership: the window stays the caller's, who keeps it until the surface is closed (on Android by `ANativeWindow_acquire`); a window
/// has one surface at a time.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_surface_open(
    gpu: *const SubsurfGpu,
    window: usize,
    width: u32,
    height: u32,
    surface_out: *mut *mut SubsurfSurface,
) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle.
        let gpu = unsafe { OpenGpu::of(gpu) }?;
        not_null("surface_out", surface_out)?;
        let none = "the device was opened for no windows: set window_system of SubsurfGpuOptions";
        let display = gpu.display.ok_or_else(|| Fault::invalid(none.to_owned()))?;
        let window = display.window(window)?;
        gpu.told(gpu.gpu.expect_alive())?;
        // SAFETY: the caller keeps display and window.
        let surface = gpu.told(unsafe { surface_of(gpu, &display, window) })?;
        if !gpu.adapter.is_surface_supported(&surface) {
            let text = "the device does not draw to this window: open another one, as by SUBSURF_BACKEND_GL".to_owned();
            return Err(Fault::Told(SubsurfStatus::Unsupported, text));
        }
        let screen = gpu.told(Screen::new(&gpu.gpu, &gpu.adapter, surface, [width, height]))?;
        let handle = Handle::create(OpenSurface { screen, display, window, gpu: gpu.clone() })?.as_ptr().cast();
        // SAFETY: the caller's pointer, which is not null.
        Ok(unsafe { write("surface_out", surface_out, handle) }?)
    })
}

/// Follows a window to another size.
///
/// `width`, `height`: its pixels; 0 stands for 1.
/// Errors: `INVALID_ARGUMENT`, `UNSUPPORTED`, `DEVICE_LOST`, `DEVICE_FAILED`.
/// Threads: any, one at a time for the surface.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_surface_resize(
    surface: *mut SubsurfSurface,
    width: u32,
    height: u32,
) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle, which nothing else uses.
        let OpenSurface { screen, gpu, .. } = unsafe { OpenSurface::of_mut(surface) }?;
        gpu.told(screen.resize(&gpu.gpu, [width, height]))
    })
}

/// Closes a surface, so that its window can go. Null is ignored, and so is what is no handle.
///
/// Ownership: the handle is gone; the window is not needed any more.
/// Threads: any, once no other uses the handle.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_surface_close(surface: *mut SubsurfSurface) {
    close::<OpenSurface, _>(surface);
}
