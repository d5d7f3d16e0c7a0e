//! Uniform blocks that lie in one buffer.

use wgpu::{BindingResource, Buffer, BufferBinding, BufferSize, BufferUsages};

use super::device::Gpu;
use super::ledger::{Purpose, Tracked};

/// Distance of blocks in a buffer, in bytes, or a divisor of it: what every device takes.
pub(crate) const BLOCK_STRIDE: u32 = 256;

/// Uniform blocks in one buffer, which is made and filled at once.
#[derive(Debug)]
pub(crate) struct Blocks {
    buffer: Tracked<Buffer>,
    /// Offset and length of each block in bytes.
    places: Vec<[usize; 2]>,
}

impl Blocks {
    /// Uploads blocks.
    pub(crate) fn new<'b>(
        gpu: &Gpu,
        purpose: Purpose,
        label: &'static str,
        blocks: impl IntoIterator<Item = &'b [u8]>,
    ) -> Self {
        let (mut bytes, mut places) = (Vec::new(), Vec::new());
        for block in blocks {
            places.push([bytes.len(), block.len()]);
            bytes.extend_from_slice(block);
            bytes.resize(bytes.len().next_multiple_of(BLOCK_STRIDE as usize), 0);
        }
        Self { buffer: gpu.buffer(purpose, label, &bytes, BufferUsages::UNIFORM), places }
    }

    /// Block number `k`, to be bound.
    pub(crate) fn block(&self, k: usize) -> BindingResource<'_> {
        let [offset, length] = self.places[k];
        let (offset, size) = (offset as u64, BufferSize::new(length as u64));
        BindingResource::Buffer(BufferBinding { buffer: &self.buffer, offset, size })
    }

    /// Bytes on the device.
    pub(crate) fn bytes(&self) -> u64 {
        self.buffer.bytes()
    }
}
