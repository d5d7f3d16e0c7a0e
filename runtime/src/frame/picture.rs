//! Pictures that are read back: for tools, which may wait.

use wgpu::{CommandEncoderDescriptor, LoadOp, TextureView};

use super::input::{Input, Target};
use super::options::{BACKGROUND_COLOUR, RuntimeOptions};
use super::prepare::Frame;
use super::renderer::Renderer;
use crate::error::Result;
use crate::gpu::{ColourTarget, Gpu, Purpose, Surface2d, TextureSpec};
use crate::technique::DepthFormat;

/// Depth of pictures, and their samples where pixels have several: what colour of the host's is drawn with.
#[derive(Debug)]
pub struct DepthTarget {
    depth: Surface2d,
    /// Target of pixels with several samples.
    samples: Option<Surface2d>,
    format: DepthFormat,
}

/// Picture on the device, with depth and samples of its own.
#[derive(Debug)]
pub struct PictureTarget {
    colour: ColourTarget,
    depth: DepthTarget,
}

impl DepthTarget {
    /// Creates depth and samples for pictures of `size` pixels, width and height, of renderers with the same options.
    ///
    /// # Errors
    /// [`Error::Unsupported`](crate::Error::Unsupported) if `size` is more than the device takes.
    pub fn new(gpu: &Gpu, size: [u32; 2], options: &RuntimeOptions) -> Result<Self> {
        let attachment = |label, format| {
            let plain = TextureSpec::attachment(label, size, format);
            gpu.texture(&TextureSpec { purpose: Purpose::Other, samples: options.samples, ..plain })
        };
        Ok(Self {
            depth: attachment("depth", options.depth.format)?,
            samples: if options.samples > 1 { Some(attachment("samples", options.format)?) } else { None },
            format: options.depth,
        })
    }

    /// Target with a colour of the same size, cleared to the usual background.
    #[must_use]
    pub fn with<'a>(&'a self, colour: &'a TextureView) -> Target<'a> {
        let (colour, resolve) = match &self.samples {
            Some(samples) => (&samples.view, Some(colour)),
            None => (colour, None),
        };
        Target {
            colour,
            load: LoadOp::Clear(BACKGROUND_COLOUR),
            resolve,
            depth: &self.depth.view,
            depth_ops: self.format.own(),
            origin: [0; 2],
        }
    }
}

impl PictureTarget {
    /// Creates a picture of `size` pixels, width and height, for renderers with the same options.
    ///
    /// # Errors
    /// [`Error::Unsupported`](crate::Error::Unsupported) if `size` is more than the device takes.
    pub fn new(gpu: &Gpu, size: [u32; 2], options: &RuntimeOptions) -> Result<Self> {
        Ok(Self { colour: gpu.target(size, options.format)?, depth: DepthTarget::new(gpu, size, options)? })
    }

    /// View of the colour.
    #[must_use]
    pub fn view(&self) -> &TextureView {
        self.colour.view()
    }

    /// The picture as a target, cleared to the usual background.
    #[must_use]
    pub fn target(&self) -> Target<'_> {
        self.depth.with(self.view())
    }

    /// Texels of the picture, row by row from the top, as they stand in it; the format must have four bytes.
    ///
    /// # Errors
    /// [`Error::Device`](crate::Error::Device) if the device is lost.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<[u8; 4]>> {
        gpu.read_picture(&self.colour)
    }
}

impl Renderer {
    /// Draws a picture, and waits for it: 8-bit rgb, row by row from the top.
    ///
    /// # Errors
    /// As [`Renderer::draw`], and [`Error::Device`](crate::Error::Device) if the device fails.
    pub fn picture(
        &self,
        gpu: &Gpu,
        frame: &mut Frame,
        input: &Input<'_>,
        picture: &PictureTarget,
    ) -> Result<Vec<[u8; 3]>> {
        self.draw_now(gpu, frame, input, &picture.target())?;
        Ok(picture.read(gpu)?.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect())
    }

    /// Draws a frame in a submission of its own, the light of a gather included, and tells what the device has to say.
    ///
    /// # Errors
    /// As [`Renderer::draw`], and [`Error::Device`](crate::Error::Device) if the device fails.
    pub fn draw_now(&self, gpu: &Gpu, frame: &mut Frame, input: &Input<'_>, target: &Target<'_>) -> Result<()> {
        self.gather(gpu, frame, input)?;
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            self.draw(gpu, &mut encoder, frame, input, target)?;
            gpu.queue.submit([encoder.finish()]);
            Ok(())
        })?
    }
}
