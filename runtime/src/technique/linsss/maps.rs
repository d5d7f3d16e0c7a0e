//! Maps of LinSSS on the screen.

use wgpu::TextureView;

use crate::error::Result;
use crate::gpu::{Gpu, HALF, Surface2d, TextureSpec, layer_of, level_of};

/// Maps for one size of picture, for materials of one number of Gaussians.
#[derive(Debug)]
pub(crate) struct Maps {
    /// Light that enters.
    pub(super) light: Surface2d,
    pub(super) by: Means,
    /// View of every level of the pyramid, from the light on; with blurs of the light alone.
    pub(super) levels: Vec<TextureView>,
    pub(super) weighted: Surface2d,
    pub(super) through: Surface2d,
    /// Blurred light by every Gaussian, and blurred weighted light, one layer each.
    pub(super) blurred: [Surface2d; 2],
    /// Views of the layers of both, to draw to.
    pub(super) layers: [Vec<TextureView>; 2],
    pub(super) depth: Surface2d,
}

/// By what light is blurred.
#[derive(Debug)]
pub(super) enum Means {
    /// The authors' shortcut: light blurred by half a texel, and by one and more, smaller and smaller.
    Pyramid([Surface2d; 2]),
    /// Light and weighted light after the blur along rows.
    Blurs([Surface2d; 2]),
}

/// Levels of the pyramid of maps of a size: down to some eight texels.
fn levels_of(size: [u32; 2]) -> u32 {
    size[0].min(size[1]).max(8).ilog2() - 2
}

impl Maps {
    /// Texels, columns and rows.
    pub(super) fn size(&self) -> [u32; 2] {
        [self.light.texture.width(), self.light.texture.height()]
    }

    /// Bytes on the device of maps of so many texels.
    pub(crate) fn bytes_of(size: [u32; 2], gaussians: usize, is_shortcut: bool) -> u64 {
        let map = TextureSpec::target("", size, HALF).bytes();
        let layers = gaussians.max(2) as u64;
        // Light, weighted and transmitted light, depth by half; two and a third for a pyramid, or two between rows and columns.
        map * if is_shortcut { 6 + layers } else { 6 + 2 * layers }
    }

    pub(crate) fn new(
        gpu: &Gpu,
        size: [u32; 2],
        gaussians: usize,
        is_shortcut: bool,
        depth: wgpu::TextureFormat,
    ) -> Result<Self> {
        let format = gpu.target_texture_format();
        let map = |label| gpu.texture(&TextureSpec::target(label, size, format));
        let light = map("light that enters")?;
        let mut levels = vec![level_of(&light, 0, 0)];
        let by = if is_shortcut {
            let slight = map("light blurred by half a texel")?;
            let spec = TextureSpec { levels: levels_of(size), ..TextureSpec::target("pyramid of light", size, format) };
            let pyramid = gpu.texture(&spec)?;
            levels.push(level_of(&slight, 0, 0));
            levels.extend((0..levels_of(size)).map(|level| level_of(&pyramid, 0, level)));
            Means::Pyramid([slight, pyramid])
        } else {
            Means::Blurs([map("light along rows")?, map("weighted light along rows")?])
        };
        let layered = |label, size| {
            let layers = TextureSpec::layered(label, size, u32::try_from(gaussians).unwrap_or(1), format).layers;
            gpu.texture(&TextureSpec { layers, ..TextureSpec::target(label, size, format) })
        };
        // With the shortcut nothing reads weighted light.
        let of_weighted = if is_shortcut { [1, 1] } else { size };
        let blurred = [layered("light by Gaussians", size)?, layered("weighted light by Gaussians", of_weighted)?];
        let views = |surface: &Surface2d| {
            let count = surface.texture.depth_or_array_layers();
            (0..count).map(|layer| layer_of(surface, layer)).collect()
        };
        Ok(Self {
            by,
            levels,
            light,
            weighted: map("weighted light")?,
            through: map("light from behind")?,
            layers: [views(&blurred[0]), views(&blurred[1])],
            blurred,
            depth: gpu.texture(&TextureSpec::attachment("map depth", size, depth))?,
        })
    }
}
