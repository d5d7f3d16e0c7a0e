//! Surface of the window, and the window that it is made anew of when it is lost.

use std::sync::Arc;

use subsurf_runtime::wgpu::{Adapter, Instance, SurfaceTexture, TextureFormat};
use subsurf_runtime::{Backend, Gpu, OnScreen, Screen};
use winit::window::Window;

use crate::error::{Error, Result};

/// Surface of a window.
pub(in crate::window) struct Canvas {
    screen: Screen<'static>,
    window: Arc<Window>,
    instance: Instance,
    adapter: Adapter,
}

/// A surface that shows nothing is no display.
fn no_display(error: subsurf_runtime::Error) -> Error {
    match error {
        error @ subsurf_runtime::Error::Surface(_) => Error::NoDisplay(error.to_string()),
        other => other.into(),
    }
}

impl Canvas {
    /// Opens the best device of a backend that draws to the window, and configures the window's surface.
    pub(in crate::window) fn open(backend: Backend, window: &Arc<Window>) -> Result<(Self, Gpu)> {
        let screen = Gpu::open_for(backend, window.clone(), window.clone())?;
        let OnScreen { gpu, surface, instance, adapter } = screen;
        let size = window.inner_size();
        let screen = Screen::new(&gpu, &adapter, surface, [size.width, size.height]).map_err(no_display)?;
        Ok((Self { screen, window: window.clone(), instance, adapter }, gpu))
    }

    pub(in crate::window) fn format(&self) -> TextureFormat {
        self.screen.format()
    }

    /// Width and height of the window in pixels.
    pub(in crate::window) fn size(&self) -> [u32; 2] {
        self.screen.size()
    }

    /// Follows the window to another size in pixels.
    pub(in crate::window) fn resize(&mut self, gpu: &Gpu, size: [u32; 2]) -> Result<()> {
        Ok(self.screen.resize(gpu, size)?)
    }

    /// The texture that is shown next; `None` if there is none this time.
    pub(in crate::window) fn texture(&mut self, gpu: &Gpu) -> Result<Option<SurfaceTexture>> {
        let Self { screen, window, instance, adapter } = self;
        let recreate = || {
            let surface = instance.create_surface(window.clone());
            surface.map_err(|error| subsurf_runtime::Error::Surface(format!("it was lost: {error}")))
        };
        screen.texture(gpu, adapter, recreate).map_err(no_display)
    }
}
