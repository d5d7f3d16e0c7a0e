//! Surface of a window: what it is configured to, and what is done when it no longer fits or is lost.

use wgpu::{
    Adapter, CompositeAlphaMode, CurrentSurfaceTexture, PresentMode, Surface, SurfaceCapabilities, SurfaceColorSpace,
    SurfaceConfiguration, SurfaceTexture, TextureFormat, TextureUsages,
};

use super::device::Gpu;
use crate::error::{Error, Result};

/// A surface is asked this often for a texture before a frame is given up.
const ATTEMPTS: usize = 3;

/// Surface of a window, configured: display values are stored as they are where the surface lets us, waits for the display,
/// opaque. Drop it before the window.
#[derive(Debug)]
pub struct Screen<'w> {
    /// `None` only while it is made anew: a window has one at a time.
    surface: Option<Surface<'w>>,
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

/// The configuration for a window of `size`.
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

impl<'w> Screen<'w> {
    /// Configures the surface of a window of `size` pixels, width and height.
    ///
    /// # Errors
    /// [`Error::Surface`] if it takes no pictures of 8 bits; [`Error::Device`] if the device refuses it.
    pub fn new(gpu: &Gpu, adapter: &Adapter, surface: Surface<'w>, size: [u32; 2]) -> Result<Self> {
        let config = configuration(&surface.get_capabilities(adapter), size);
        let config = config.ok_or_else(|| Error::Surface("it takes no pictures of 8 bits".to_owned()))?;
        let mut screen = Self { surface: Some(surface), config, is_suboptimal: false };
        screen.configure(gpu)?;
        Ok(screen)
    }

    /// Format of its textures.
    #[must_use]
    pub fn format(&self) -> TextureFormat {
        self.config.format
    }

    /// Width and height of the window in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.config.width, self.config.height]
    }

    /// Follows the window to another size in pixels; a window that is minimised has 1 pixel.
    ///
    /// # Errors
    /// [`Error::Device`] if the device refuses it.
    pub fn resize(&mut self, gpu: &Gpu, size: [u32; 2]) -> Result<()> {
        [self.config.width, self.config.height] = size.map(|side| side.max(1));
        self.configure(gpu)
    }

    fn configure(&mut self, gpu: &Gpu) -> Result<()> {
        self.is_suboptimal = false;
        let most = gpu.device.limits().max_texture_dimension_2d;
        let side = self.config.width.max(self.config.height);
        if side > most {
            return Err(Error::Unsupported { what: "sides of windows", need: side.into(), have: most.into() });
        }
        match &self.surface {
            Some(surface) => gpu.checked(|| surface.configure(&gpu.device, &self.config)),
            None => Ok(()),
        }
    }

    /// The texture that is shown next; `None` if there is none this time. `recreate` makes the window's surface anew when it is
    /// lost.
    ///
    /// # Errors
    /// What `recreate` says; [`Error::Surface`] if the new surface has other formats, which pipelines are not for;
    /// [`Error::Device`] if the device fails.
    pub fn texture(
        &mut self,
        gpu: &Gpu,
        adapter: &Adapter,
        mut recreate: impl FnMut() -> Result<Surface<'w>>,
    ) -> Result<Option<SurfaceTexture>> {
        if self.is_suboptimal {
            self.configure(gpu)?;
        }
        for _ in 0..ATTEMPTS {
            let Some(surface) = &self.surface else {
                let surface = recreate()?;
                if !surface.get_capabilities(adapter).formats.contains(&self.config.format) {
                    return Err(Error::Surface("it came back in another format".to_owned()));
                }
                self.surface = Some(surface);
                self.configure(gpu)?;
                continue;
            };
            // What the device complains of here is answered by configuring.
            let answer = gpu.checked(|| surface.get_current_texture()).unwrap_or(CurrentSurfaceTexture::Validation);
            let next = step(&answer);
            match (next, answer) {
                (_, CurrentSurfaceTexture::Success(texture) | CurrentSurfaceTexture::Suboptimal(texture)) => {
                    self.is_suboptimal = next == Step::DrawOnce;
                    return Ok(Some(texture));
                }
                (Step::Configure, _) => self.configure(gpu)?,
                (Step::Recreate, _) => self.surface = None,
                _ => return Ok(None),
            }
        }
        Ok(None)
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
