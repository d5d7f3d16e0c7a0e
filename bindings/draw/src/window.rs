//! Window systems: how their displays and windows are named to the device.

use std::ffi::c_void;
use std::ptr::NonNull;

use subsurf_c::shared::Failure;
use subsurf_runtime::wgpu::rwh::{
    AndroidDisplayHandle, AndroidNdkWindowHandle, DisplayHandle, HandleError, HasDisplayHandle, RawDisplayHandle,
    RawWindowHandle, WaylandDisplayHandle, WaylandWindowHandle, XlibDisplayHandle, XlibWindowHandle,
};

use crate::fault::{Fault, Result};

/// Window system whose windows are drawn to.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubsurfWindowSystem {
    /// None: pictures alone.
    None = 0,
    /// Android: windows are `ANativeWindow *`; there is no display.
    Android = 1,
    /// X11 by Xlib: displays are `Display *`, windows are `Window`. Threads that draw need `XInitThreads`.
    X11 = 2,
    /// Wayland: displays are `wl_display *`, windows are `wl_surface *`.
    Wayland = 3,
}

/// Display of a caller, which stays open as long as what is made with it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Display {
    pub(crate) system: SubsurfWindowSystem,
    raw: RawDisplayHandle,
}

impl Display {
    /// Display behind a pointer; none for no windows.
    pub(crate) fn new(system: SubsurfWindowSystem, display: *mut c_void) -> Result<Option<Self>> {
        let pointer = || NonNull::new(display).ok_or(Fault::Failure(Failure::Null("display")));
        let raw = match system {
            SubsurfWindowSystem::None => return Ok(None),
            SubsurfWindowSystem::Android => RawDisplayHandle::Android(AndroidDisplayHandle::new()),
            SubsurfWindowSystem::X11 => RawDisplayHandle::Xlib(XlibDisplayHandle::new(Some(pointer()?), 0)),
            SubsurfWindowSystem::Wayland => RawDisplayHandle::Wayland(WaylandDisplayHandle::new(pointer()?)),
        };
        Ok(Some(Self { system, raw }))
    }

    pub(crate) fn raw(&self) -> RawDisplayHandle {
        self.raw
    }

    /// Window of the display.
    pub(crate) fn window(&self, window: usize) -> Result<RawWindowHandle> {
        let null = || Fault::Failure(Failure::Null("window"));
        let pointer = || NonNull::new(window as *mut c_void).ok_or_else(null);
        Ok(match self.system {
            SubsurfWindowSystem::X11 if window == 0 => return Err(null()),
            SubsurfWindowSystem::X11 => {
                let window = window
                    .try_into()
                    .map_err(|_| Fault::invalid(format!("window is {window:#x}, which is none of X11")))?;
                RawWindowHandle::Xlib(XlibWindowHandle::new(window))
            }
            SubsurfWindowSystem::Wayland => RawWindowHandle::Wayland(WaylandWindowHandle::new(pointer()?)),
            SubsurfWindowSystem::Android | SubsurfWindowSystem::None => {
                RawWindowHandle::AndroidNdk(AndroidNdkWindowHandle::new(pointer()?))
            }
        })
    }
}

// SAFETY: whoever hands in a display says that threads may use it.
unsafe impl Send for Display {}
// SAFETY: as above.
unsafe impl Sync for Display {}

impl HasDisplayHandle for Display {
    fn display_handle(&self) -> std::result::Result<DisplayHandle<'_>, HandleError> {
        // SAFETY: the caller of subsurf_gpu_open keeps the display open.
        Ok(unsafe { DisplayHandle::borrow_raw(self.raw) })
    }
}
