//! Pictures to draw to, and reading texels back from the device.

use bytemuck::Pod;
use half::f16;
use wgpu::{Buffer, BufferUsages, CommandEncoderDescriptor, TexelCopyBufferInfo, TexelCopyBufferLayout, Texture};

use super::device::Gpu;
use super::ledger::Purpose;
use super::resource::{Surface2d, TextureSpec, extent};
use crate::error::{Error, Result};

/// Colour of a picture on the device.
#[derive(Debug)]
pub struct ColourTarget(pub(crate) Surface2d);

impl ColourTarget {
    /// View to draw to.
    #[must_use]
    pub fn view(&self) -> &wgpu::TextureView {
        &self.0.view
    }
}

impl Gpu {
    /// Creates a picture of `size` pixels, width and height, to draw to.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if `size` is more than the device takes.
    pub fn target(&self, size: [u32; 2], format: wgpu::TextureFormat) -> Result<ColourTarget> {
        Ok(ColourTarget(
            self.texture(&TextureSpec { purpose: Purpose::Other, ..TextureSpec::target("picture", size, format) })?,
        ))
    }

    /// Texels of a picture, row by row from the top, as they stand in it; the picture must have four bytes to a texel.
    ///
    /// # Errors
    /// [`Error::Device`] if the device is lost.
    pub fn read_picture(&self, target: &ColourTarget) -> Result<Vec<[u8; 4]>> {
        self.read(&target.0.texture)
    }

    /// Texels of a texture, the finest level of its first layer, row by row.
    pub(crate) fn read<T: Pod>(&self, texture: &Texture) -> Result<Vec<T>> {
        self.read_level(texture, 0, 0)
    }

    /// Texels of one mipmap level of a layer, row by row.
    fn read_level<T: Pod>(&self, texture: &Texture, layer: u32, mip_level: u32) -> Result<Vec<T>> {
        let texel = texture.format().block_copy_size(None).unwrap_or(4);
        let [width, height] = [texture.width(), texture.height()].map(|side| (side >> mip_level).max(1));
        let row = (width * texel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        // As many rows at a time as a buffer may have.
        let most = self.device.limits().max_buffer_size / u64::from(row);
        let most = u32::try_from(most).unwrap_or(u32::MAX).clamp(1, height.max(1));
        let mut texels = Vec::with_capacity(width as usize * height as usize);
        for first in (0..height).step_by(most as usize) {
            let rows = most.min(height - first);
            let origin = wgpu::Origin3d { x: 0, y: first, z: layer };
            let from = wgpu::TexelCopyTextureInfo { mip_level, origin, ..texture.as_image_copy() };
            self.read_rows(from, [width, rows], row, &mut texels)?;
        }
        Ok(texels)
    }

    /// Appends the texels of some rows to `texels`; in the buffer between, rows are `row` bytes apart.
    fn read_rows<T: Pod>(
        &self,
        from: wgpu::TexelCopyTextureInfo<'_>,
        size: [u32; 2],
        row: u32,
        texels: &mut Vec<T>,
    ) -> Result<()> {
        let texel = from.texture.format().block_copy_size(None).unwrap_or(4);
        let [width, height] = size;
        let bytes = u64::from(row) * u64::from(height);
        let buffer = self.checked(|| {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("read back"),
                size: bytes,
                usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
                mapped_at_creation: false,
            })
        })?;
        let buffer = self.ledger().enter(Purpose::Other, buffer, bytes);
        self.checked(|| {
            let mut encoder = self.device.create_command_encoder(&CommandEncoderDescriptor::default());
            let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
            let to = TexelCopyBufferInfo { buffer: &buffer, layout };
            encoder.copy_texture_to_buffer(from, to, extent(size, 1));
            self.queue.submit([encoder.finish()]);
        })?;
        let bytes: Vec<u8> = self.read_buffer(&buffer)?;
        let rows = bytes.chunks(row as usize).map(|bytes| &bytes[..(width * texel) as usize]);
        texels.extend(rows.flat_map(bytemuck::pod_collect_to_vec::<u8, T>));
        Ok(())
    }

    /// Contents of a buffer that can be mapped, once the device has done everything.
    pub(crate) fn read_buffer<T: Pod>(&self, buffer: &Buffer) -> Result<Vec<T>> {
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver waits below; if it is gone, nobody wants the answer.
            let _ = sender.send(result);
        });
        self.finish()?;
        let mapped = receiver.recv().map_err(|_| Error::Device("the device never answered".to_owned()))?;
        mapped.map_err(|error| Error::Device(error.to_string()))?;
        let bytes = buffer.get_mapped_range(..).map_err(|error| Error::Device(error.to_string()))?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }

    /// Linear rgb of every texel of a target of [`Gpu::map_format`], half floats or their bits, row by row.
    pub(crate) fn read_rgb(&self, texture: &Texture) -> Result<Vec<[f32; 3]>> {
        self.read_rgb_level(texture, 0, 0)
    }

    /// The same of one mipmap level of a layer.
    pub(crate) fn read_rgb_level(&self, texture: &Texture, layer: u32, level: u32) -> Result<Vec<[f32; 3]>> {
        let texels: Vec<[u16; 4]> = self.read_level(texture, layer, level)?;
        Ok(texels.iter().map(|[r, g, b, _]| [*r, *g, *b].map(|bits| f16::from_bits(bits).to_f32())).collect())
    }
}
