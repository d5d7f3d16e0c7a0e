//! Maps of LinSSS on the screen.

use wgpu::TextureView;

use crate::error::Result;
use crate::gpu::{Gpu, HALF, Surface2d, TextureSpec, layer_of, level_of};

/// Maps for one size of picture, for materials of one number of Gaussians.
#[derive(Debug)]
pub(crate) struct Maps {
    /// Light that enters; with the shortcut the pyramid, of which it is the finest level.
    pub(super) light: Surface2d,
    /// View of every level of it.
    pub(super) levels: Vec<TextureView>,
    pub(super) weighted: Surface2d,
    pub(super) through: Surface2d,
    /// Both after the blur along rows; none with the shortcut.
    pub(super) between: Option<[Surface2d; 2]>,
    /// Blurred light by every Gaussian, and blurred weighted light, one layer each.
    pub(super) blurred: [Surface2d; 2],
    /// Views of the layers of both, to draw to.
    pub(super) layers: [Vec<TextureView>; 2],
    pub(super) depth: Surface2d,
}

/// Levels of the pyramid of maps of a size: down to some eight texels.
fn levels_of(size: [u32; 2]) -> u32 {
    size[0].min(size[1]).max(8).ilog2() - 2
}

impl Maps {
    /// Bytes on the device of maps of so many texels.
    pub(crate) fn bytes_of(size: [u32; 2], gaussians: usize, is_shortcut: bool) -> u64 {
        let map = TextureSpec::target("", size, HALF).bytes();
        let layers = gaussians.max(2) as u64;
        // Light, weighted and transmitted light, depth by half; a third more for a pyramid, or what is between rows and columns.
        map * if is_shortcut { 4 + 2 + layers } else { 6 + 2 * layers }
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
        let levels = if is_shortcut { levels_of(size) } else { 1 };
        let light = gpu.texture(&TextureSpec { levels, ..TextureSpec::target("pyramid of light", size, format) })?;
        let layered = |label, count: usize| {
            let layers = TextureSpec::layered(label, size, u32::try_from(count).unwrap_or(1), format).layers;
            gpu.texture(&TextureSpec { layers, ..TextureSpec::target(label, size, format) })
        };
        let blurred = [
            layered("light by Gaussians", gaussians)?,
            layered("weighted light by Gaussians", if is_shortcut { 1 } else { gaussians })?,
        ];
        let views = |surface: &Surface2d| {
            let count = surface.texture.depth_or_array_layers();
            (0..count).map(|layer| layer_of(surface, layer)).collect()
        };
        let between = if is_shortcut { None } else { Some([map("light along rows")?, map("weighted light along rows")?]) };
        Ok(Self {
            levels: (0..levels).map(|level| level_of(&light, 0, level)).collect(),
            light,
            weighted: map("weighted light")?,
            through: map("light from behind")?,
            between,
            layers: [views(&blurred[0]), views(&blurred[1])],
            blurred,
            depth: gpu.texture(&TextureSpec::attachment("map depth", size, depth))?,
        })
    }
}
