//! Bytes on their way into textures, at once or in pieces; and copies of what was drawn.

use std::borrow::Cow;

use subsurf_shaders::TargetFormat;
use wgpu::{
    BufferUsages, CommandEncoder, Origin3d, TexelCopyBufferInfo, TexelCopyBufferLayout, TexelCopyTextureInfo, Texture,
};

use super::device::Gpu;
use super::resource::extent;
use crate::error::Result;

/// Most bytes of a piece, unless one row has more: a step of a load takes no longer than a part of a frame.
pub(crate) const PIECE_BYTES: usize = 1 << 20;

/// Rows of one layer of a texture whose bytes wait to be written.
#[derive(Debug)]
pub(crate) struct Fill<'a> {
    texture: Texture,
    layer: u32,
    first_row: u32,
    bytes: Cow<'a, [u8]>,
}

impl<'a> Fill<'a> {
    /// Pieces of the finest level of a layer, row by row; of the last texel, what is missing is 0, and texels beyond it stay as
    /// they are.
    pub(crate) fn pieces(texture: &Texture, layer: u32, bytes: &'a [u8]) -> impl Iterator<Item = Self> + use<'a> {
        let row = row_bytes(texture, 0);
        let rows = (PIECE_BYTES / row).max(1);
        let (texture, texel) = (texture.clone(), texel_bytes(texture));
        let whole = move |bytes: &'a [u8]| match bytes.len() % texel {
            0 => Cow::Borrowed(bytes),
            part => [bytes, &vec![0; texel - part]].concat().into(),
        };
        bytes.chunks(rows * row).enumerate().map(move |(piece, bytes)| Self {
            texture: texture.clone(),
            layer,
            first_row: u32::try_from(piece * rows).unwrap_or(u32::MAX),
            bytes: whole(bytes),
        })
    }

    /// All of the finest level of the first layer, in one piece.
    pub(crate) fn whole(texture: &Texture, bytes: Vec<u8>) -> Self {
        Self { texture: texture.clone(), layer: 0, first_row: 0, bytes: bytes.into() }
    }

    /// The same with bytes of its own.
    #[cfg(feature = "transfer")]
    pub(crate) fn into_owned(self) -> Fill<'static> {
        Fill { bytes: self.bytes.into_owned().into(), ..self }
    }

    /// Number of bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.bytes.len()
    }

    /// Hands the bytes to the queue.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the device is lost.
    pub(crate) fn write(&self, gpu: &Gpu) -> Result<()> {
        gpu.checked(|| gpu.fill_rows(&self.texture, self.layer, 0, self.first_row, &self.bytes))
    }
}

fn texel_bytes(texture: &Texture) -> usize {
    texture.format().block_copy_size(None).unwrap_or(4) as usize
}

/// Bytes of a row of a mipmap level.
fn row_bytes(texture: &Texture, level: u32) -> usize {
    (texture.width() >> level).max(1) as usize * texel_bytes(texture)
}

impl Gpu {
    /// Fills the finest level of one layer from `bytes`, row by row; texels beyond the last byte stay as they are.
    pub(crate) fn fill(&self, texture: &Texture, layer: u32, bytes: &[u8]) {
        self.fill_rows(texture, layer, 0, 0, bytes);
    }

    /// Fills one level of one layer from `bytes`, row by row; texels beyond the last byte stay as they are.
    pub(crate) fn fill_level(&self, texture: &Texture, layer: u32, level: u32, bytes: &[u8]) {
        self.fill_rows(texture, layer, level, 0, bytes);
    }

    /// Fills one level of one layer from a row on.
    fn fill_rows(&self, texture: &Texture, layer: u32, mip_level: u32, first: u32, bytes: &[u8]) {
        let row = row_bytes(texture, mip_level);
        let texel = u32::try_from(texel_bytes(texture)).unwrap_or(4);
        let columns = (texture.width() >> mip_level).max(1);
        let (whole, part) = bytes.split_at(bytes.len() / row * row);
        let rows = u32::try_from(whole.len() / row).unwrap_or(u32::MAX);
        let rest = u32::try_from(part.len()).unwrap_or(0) / texel;
        for (bytes, y, width, height) in [(whole, first, columns, rows), (part, first + rows, rest, 1)] {
            if width > 0 && height > 0 {
                let origin = Origin3d { x: 0, y, z: layer };
                let to = TexelCopyTextureInfo { origin, mip_level, ..texture.as_image_copy() };
                let layout = TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(width * texel),
                    rows_per_image: Some(height),
                };
                self.queue.write_texture(to, bytes, layout, extent([width, height], 1));
            }
        }
    }

    /// Copies the first `size` texels of the first `layers` layers of an intermediate target to a level of half floats, from a layer
    /// on.
    ///
    /// Bits of half floats in integers become half floats by way of a buffer.
    pub(crate) fn copy_target(
        &self,
        encoder: &mut CommandEncoder,
        from: &Texture,
        (to, layer, mip_level): (&Texture, u32, u32),
        size: [u32; 2],
        layers: u32,
    ) {
        let from = from.as_image_copy();
        let to = TexelCopyTextureInfo { origin: Origin3d { x: 0, y: 0, z: layer }, mip_level, ..to.as_image_copy() };
        match self.target_format() {
            TargetFormat::Half => encoder.copy_texture_to_texture(from, to, extent(size, layers)),
            TargetFormat::Packed => {
                let texel = to.texture.format().block_copy_size(None).unwrap_or(8);
                let row = (size[0] * texel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
                let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("bits of half floats"),
                    size: u64::from(row) * u64::from(size[1]) * u64::from(layers),
                    usage: BufferUsages::COPY_SRC | BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                });
                let rows_per_image = Some(size[1]);
                let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image };
                let through = TexelCopyBufferInfo { buffer: &buffer, layout };
                encoder.copy_texture_to_buffer(from, through, extent(size, layers));
                encoder.copy_buffer_to_texture(through, to, extent(size, layers));
            }
        }
    }
}
