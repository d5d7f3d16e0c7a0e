//! Textures and buffers, entered into the ledger and filled.

use bytemuck::Pod;
use subsurf_shaders::uniform::ROW;
use wgpu::{
    Buffer, BufferUsages, Extent3d, Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages,
    TextureView, TextureViewDescriptor, TextureViewDimension,
};

use super::device::Gpu;
use super::ledger::{Purpose, Tracked};
use crate::error::{Error, Result};

/// Format of depth.
pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth24Plus;
/// Format of maps that passes add up or sample.
pub(crate) const HALF: TextureFormat = TextureFormat::Rgba16Float;

/// Size, format and use of a texture.
pub(crate) struct TextureSpec {
    /// Name for debuggers.
    pub(crate) label: &'static str,
    /// What it is entered into the ledger for.
    pub(crate) purpose: Purpose,
    /// Width and height in texels.
    pub(crate) size: [u32; 2],
    /// Layers; more than one make an array.
    pub(crate) layers: u32,
    /// Mipmap levels, each half as large as the one before.
    pub(crate) levels: u32,
    /// Samples to a texel.
    pub(crate) samples: u32,
    pub(crate) format: TextureFormat,
    pub(crate) usage: TextureUsages,
}

impl TextureSpec {
    /// Table of a material: written from the CPU, read by shaders.
    pub(crate) fn table(label: &'static str, size: [u32; 2], format: TextureFormat) -> Self {
        Self {
            label,
            purpose: Purpose::Material,
            size,
            layers: 1,
            levels: 1,
            samples: 1,
            format,
            usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        }
    }

    /// Target of a frame: written and read by shaders, and read back.
    pub(crate) fn target(label: &'static str, size: [u32; 2], format: TextureFormat) -> Self {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        Self { usage, purpose: Purpose::Frame, ..Self::table(label, size, format) }
    }

    /// Attachment of a frame: only drawn to.
    pub(crate) fn attachment(label: &'static str, size: [u32; 2], format: TextureFormat) -> Self {
        Self { usage: TextureUsages::RENDER_ATTACHMENT, ..Self::target(label, size, format) }
    }

    /// Table of layers, at least as many as asked for, two at least: its view is of an array.
    ///
    /// The GL backend makes a plain texture of one layer and a cube of six square ones (or a multiple of six), whatever
    /// the shader wants to see: such numbers get a layer more, which stays empty.
    pub(crate) fn layered(label: &'static str, size: [u32; 2], layers: u32, format: TextureFormat) -> Self {
        let cube = size[0] == size[1] && layers.is_multiple_of(6);
        let layers = if layers == 1 || cube { layers + 1 } else { layers };
        Self { layers, ..Self::table(label, size, format) }
    }

    /// Table for a plain array of `len` entries, [`ROW`] to a row, or all of them where they are fewer.
    pub(crate) fn array(label: &'static str, len: usize, format: TextureFormat) -> Self {
        Self::table(label, array_size(len), format)
    }

    /// Bytes on the device: texel size × texels of all levels, layers and samples.
    pub(crate) fn bytes(&self) -> u64 {
        let texel = match self.format {
            // Single floats, and a word for the stencil.
            TextureFormat::Depth32FloatStencil8 => 8,
            format => u64::from(format.block_copy_size(None).unwrap_or(4)),
        };
        let texels = |level: u32| self.size.map(|side| u64::from((side >> level).max(1))).iter().product::<u64>();
        (0..self.levels).map(texels).sum::<u64>() * u64::from(self.layers) * u64::from(self.samples) * texel
    }
}

/// Width and height of a texture for a plain array of `len` entries.
pub(crate) fn array_size(len: usize) -> [u32; 2] {
    let len = u32::try_from(len).unwrap_or(u32::MAX);
    [len.clamp(1, ROW), len.div_ceil(ROW).max(1)]
}

/// Texture, and the view of all of it.
#[derive(Debug)]
pub(crate) struct Surface2d {
    pub(crate) texture: Tracked<Texture>,
    pub(crate) view: TextureView,
}

/// View of the finest level of one layer, to draw to.
pub(crate) fn layer_of(surface: &Surface2d, layer: u32) -> TextureView {
    level_of(surface, layer, 0)
}

/// View of one level of one layer, to draw to.
pub(crate) fn level_of(surface: &Surface2d, layer: u32, level: u32) -> TextureView {
    surface.texture.create_view(&TextureViewDescriptor {
        dimension: Some(TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
        base_mip_level: level,
        mip_level_count: Some(1),
        ..Default::default()
    })
}

/// View of the first layers of one level as an array, to read.
pub(crate) fn layers_of(surface: &Surface2d, layers: u32, level: u32) -> TextureView {
    surface.texture.create_view(&TextureViewDescriptor {
        dimension: Some(TextureViewDimension::D2Array),
        array_layer_count: Some(layers),
        base_mip_level: level,
        mip_level_count: Some(1),
        ..Default::default()
    })
}

impl Gpu {
    /// Creates a texture.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub(crate) fn texture(&self, spec: &TextureSpec) -> Result<Surface2d> {
        let limits = self.device.limits();
        let unsupported =
            |what, need: u32, have: u32| Error::Unsupported { what, need: need.into(), have: have.into() };
        let side = spec.size[0].max(spec.size[1]);
        if side > limits.max_texture_dimension_2d {
            return Err(unsupported("texture sides", side, limits.max_texture_dimension_2d));
        }
        if spec.layers > limits.max_texture_array_layers {
            return Err(unsupported("texture layers", spec.layers, limits.max_texture_array_layers));
        }
        let texture = self.checked(|| {
            self.device.create_texture(&TextureDescriptor {
                label: Some(spec.label),
                size: extent(spec.size, spec.layers),
                mip_level_count: spec.levels,
                sample_count: spec.samples,
                dimension: TextureDimension::D2,
                format: spec.format,
                usage: spec.usage,
                view_formats: &[],
            })
        })?;
        let view = texture.create_view(&TextureViewDescriptor::default());
        Ok(Surface2d { texture: self.ledger().enter(spec.purpose, texture, spec.bytes()), view })
    }

    /// Creates a texture of one layer with its contents.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub(crate) fn filled(&self, spec: &TextureSpec, bytes: &[u8]) -> Result<Surface2d> {
        let surface = self.texture(spec)?;
        self.checked(|| self.fill(&surface.texture, 0, bytes))?;
        Ok(surface)
    }

    /// Creates a buffer with its contents, a multiple of four bytes.
    ///
    /// Where the device is lost or full, the buffer is invalid, and the first pass that uses it says so:
    /// `create_buffer_init` would panic.
    pub(crate) fn buffer(
        &self,
        purpose: Purpose,
        label: &'static str,
        contents: &[u8],
        usage: BufferUsages,
    ) -> Tracked<Buffer> {
        let bytes = contents.len() as u64;
        let mut buffer = None;
        let filled = self.checked(|| {
            let buffer = buffer.insert(self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes,
                usage: usage | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
            self.queue.write_buffer(buffer, 0, contents);
        });
        debug_assert!(filled.is_ok() || contents.len().is_multiple_of(4), "{label}: {bytes} bytes");
        self.ledger().enter(purpose, buffer.expect("made above, valid or not"), bytes)
    }

    /// Creates the buffer of a uniform block.
    pub(crate) fn uniform<T: Pod>(&self, purpose: Purpose, label: &'static str, block: &T) -> Tracked<Buffer> {
        self.buffer(purpose, label, bytemuck::bytes_of(block), BufferUsages::UNIFORM | BufferUsages::COPY_DST)
    }
}

/// Extent of a copy or a texture.
pub(super) fn extent(size: [u32; 2], layers: u32) -> Extent3d {
    Extent3d { width: size[0], height: size[1], depth_or_array_layers: layers }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_those_of_all_levels_and_samples() {
        let bytes = |format| TextureSpec::attachment("", [4, 2], format).bytes();
        assert_eq!(bytes(TextureFormat::Depth16Unorm), 16);
        assert_eq!(bytes(TextureFormat::Depth24Plus), 32);
        assert_eq!(bytes(TextureFormat::Depth24PlusStencil8), 32);
        assert_eq!(bytes(TextureFormat::Depth32FloatStencil8), 64);
        let plain = TextureSpec::table("", [4, 2], TextureFormat::Rgba8Unorm);
        assert_eq!(TextureSpec { levels: 3, ..plain }.bytes(), 4 * (8 + 2 + 1));
        let plain = TextureSpec::table("", [4, 2], TextureFormat::Rgba8Unorm);
        assert_eq!(TextureSpec { samples: 4, layers: 2, ..plain }.bytes(), 4 * 8 * 4 * 2);
    }
}
