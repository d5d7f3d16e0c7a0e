//! Surface of the window: what it is configured to, and what is done when it is lost.

use std::sync::Arc;

use subsurf_runtime::wgpu::{
    Adapter, CompositeAlphaMode, CurrentSurfaceTexture, Instance, PresentMode, Surface, SurfaceCapabilities,
    SurfaceColorSpace, SurfaceConfiguration, SurfaceTexture, TextureFormat, TextureUsages,
};
use subsurf_runtime::{Backend, Gpu, OnScreen};
use winit::window::Window;

use crate::error::{Error, Result};

/// A surface is asked this often for a texture before a frame is given up.
const ATTEMPTS: usize = 3;

/// Surface of a window.
pub(in crate::window) struct Canvas {
    window: Arc<Window>,
    instance: Instance,
    adapter: Adapter,
    /// `None` only while it is made anew: a window has one at a time.
    surface: Option<Surface<'static>>,
    config: SurfaceConfiguration,
    /// The last texture did not quite fit the window.
    is_suboptimal: bool,
}

/// Step that a surface's answer asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    Draw,
    /// Draw, and configure before the next frame.
    DrawOnce,
    Configure,
    Recreate,
    Wait,
}

fn step(answer: &CurrentSurfaceTexture) -> Step {
    match answer {
        CurrentSurfaceTexture::Success(_) => Step::Draw,
        CurrentSurfaceTexture::Suboptimal(_) => Step::DrawOnce,
        CurrentSurfaceTexture::Outdated | CurrentSurfaceTexture::Validation => Step::Configure,
        CurrentSurfaceTexture::Lost => Step::Recreate,
        CurrentSurfaceTexture::Timeout | CurrentSurfaceTexture::Occluded => Step::Wait,
    }
}

/// The configuration for a window of `size`: display values are stored as they are where the surface lets us, waits for
/// the display, opaque.
fn configuration(capabilities: &SurfaceCapabilities, size: [u32; 2]) -> Option<SurfaceConfiguration> {
    let plain = [TextureFormat::Bgra8Unorm, TextureFormat::Rgba8Unorm];
    let coded = [TextureFormat::Bgra8UnormSrgb, TextureFormat::Rgba8UnormSrgb];
    let format = plain.into_iter().chain(coded).find(|format| capabilities.formats.contains(format))?;
    let opaque = capabilities.alpha_modes.contains(&CompositeAlphaMode::Opaque);
    Some(SurfaceConfiguration {
        usage: TextureUsages::RENDER_ATTACHMENT,
        format,
        color_space: SurfaceColorSpace::Auto,
        width: size[0].max(1),
        height: size[1].max(1),
        present_mode: PresentMode::AutoVsync,
        desired_maximum_frame_latency: 2,
        alpha_mode: if opaque { CompositeAlphaMode::Opaque } else { CompositeAlphaMode::Auto },
        view_formats: Vec::new(),
    })
}

impl Canvas {
    /// Opens the best device of a backend that draws to the window, and configures the window's surface.
    pub(in crate::window) fn open(backend: Backend, window: &Arc<Window>) -> Result<(Self, Gpu)> {
        let screen = Gpu::open_for(backend, window.clone(), window.clone())?;
        let OnScreen { gpu, surface, instance, adapter } = screen;
        let size = window.inner_size();
        let config = configuration(&surface.get_capabilities(&adapter), [size.width, size.height]);
        let config = config.ok_or_else(|| Error::NoDisplay("the window takes no pictures of 8 bits".to_owned()))?;
        surface.configure(gpu.device(), &config);
        let window = window.clone();
        Ok((Self { window, instance, adapter, surface: Some(surface), config, is_suboptimal: false }, gpu))
    }

    pub(in crate::window) fn format(&self) -> TextureFormat {
        self.config.format
    }

    /// Width and height of the window in pixels.
    pub(in crate::window) fn size(&self) -> [u32; 2] {
        [self.config.width, self.config.height]
    }

    /// Follows the window to another size in pixels.
    pub(in crate::window) fn resize(&mut self, gpu: &Gpu, size: [u32; 2]) {
        [self.config.width, self.config.height] = size.map(|side| side.max(1));
        self.configure(gpu);
    }

    fn configure(&mut self, gpu: &Gpu) {
        if let Some(surface) = &self.surface {
            surface.configure(gpu.device(), &self.config);
        }
        self.is_suboptimal = false;
    }

    /// The texture that is shown next; `None` if there is none this time.
    pub(in crate::window) fn texture(&mut self, gpu: &Gpu) -> Result<Option<SurfaceTexture>> {
        if self.is_suboptimal {
            self.configure(gpu);
        }
        for _ in 0..ATTEMPTS {
            let Some(surface) = &self.surface else {
                self.recreate(gpu)?;
                continue;
            };
            let answer = surface.get_current_texture();
            let next = step(&answer);
            match (next, answer) {
                (_, CurrentSurfaceTexture::Success(texture) | CurrentSurfaceTexture::Suboptimal(texture)) => {
                    self.is_suboptimal = next == Step::DrawOnce;
                    return Ok(Some(texture));
                }
                (Step::Configure, _) => self.configure(gpu),
                (Step::Recreate, _) => self.recreate(gpu)?,
                _ => return Ok(None),
            }
        }
        Ok(None)
    }

    fn recreate(&mut self, gpu: &Gpu) -> Result<()> {
        self.surface = None;
        let surface = self.instance.create_surface(self.window.clone());
        let surface = surface.map_err(|error| Error::NoDisplay(format!("the window's surface was lost: {error}")))?;
        // Another one may have other formats; pipelines are for the one that there was.
        if !surface.get_capabilities(&self.adapter).formats.contains(&self.config.format) {
            return Err(Error::NoDisplay("the window's surface came back in another format".to_owned()));
        }
        self.surface = Some(surface);
        self.configure(gpu);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_answer_without_a_texture_has_its_remedy() {
        assert_eq!(step(&CurrentSurfaceTexture::Outdated), Step::Configure);
        assert_eq!(step(&CurrentSurfaceTexture::Validation), Step::Configure);
        assert_eq!(step(&CurrentSurfaceTexture::Lost), Step::Recreate);
        assert_eq!(step(&CurrentSurfaceTexture::Timeout), Step::Wait);
        assert_eq!(step(&CurrentSurfaceTexture::Occluded), Step::Wait);
    }

    #[test]
    fn display_values_are_stored_as_they_are_where_the_surface_lets_us() {
        let capabilities = |formats: &[TextureFormat]| SurfaceCapabilities {
            formats: formats.to_vec(),
            alpha_modes: vec![CompositeAlphaMode::Opaque],
            ..Default::default()
        };
        let format = |formats: &[TextureFormat]| configuration(&capabilities(formats), [8, 8]).map(|c| c.format);
        let (plain, coded) = (TextureFormat::Rgba8Unorm, TextureFormat::Bgra8UnormSrgb);
        assert_eq!(format(&[coded, plain]), Some(plain));
        assert_eq!(format(&[TextureFormat::Rgba16Float, coded]), Some(coded));
        assert_eq!(format(&[]), None);
        let minimised = configuration(&capabilities(&[plain]), [0, 0]).unwrap();
        assert_eq!([minimised.width, minimised.height], [1, 1], "a minimised window has no pixels");
    }
}
