//! Homogeneous materials for separable kernels on the device.

use subsurf_decoder::Kernel;
use subsurf_decoder::kernel::KernelHeader;
use subsurf_shaders::uniform::{KernelProfile, KernelTerm};
use wgpu::{BindingResource, TextureFormat};

use crate::error::Result;
use crate::gpu::{Blocks, Fill, Gpu, Purpose, Surface2d, TextureSpec};

/// Homogeneous material on the device: the taps of its separable kernel, and the tail of its profile.
#[derive(Debug)]
pub struct KernelMaterial {
    header: KernelHeader,
    narrowest_mm: f32,
    /// Blocks of the profile, and of the terms: along rows and along columns for each.
    blocks: Blocks,
    /// T of every node, a texel each.
    tail: Surface2d,
}

impl KernelMaterial {
    /// Uploads the blocks of a kernel, and makes room for its tail, which has to be filled.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the device is lost.
    pub(crate) fn begin(gpu: &Gpu, kernel: &Kernel<'_>) -> Result<(Self, Fill<'static>)> {
        let header = *kernel.header();
        let (profile, terms) = (KernelProfile::new(kernel), KernelTerm::of(kernel));
        let blocks = std::iter::once(bytemuck::bytes_of(&profile));
        let blocks = blocks.chain(terms.iter().flatten().map(bytemuck::bytes_of));
        let size = [header.tail_nodes.into(), 1];
        let tail = gpu.texture(&TextureSpec::table("tail of a profile", size, TextureFormat::Rgba32Float))?;
        let values: Vec<f32> = kernel.tail().iter().collect();
        let (rows, _) = values.as_chunks();
        let texels: Vec<[f32; 4]> = rows.iter().map(|[r, g, b]| [*r, *g, *b, 0.0]).collect();
        let fill = Fill::whole(&tail.texture, bytemuck::cast_slice(&texels).to_vec());
        let material = Self {
            header,
            narrowest_mm: kernel.offsets().get(1).unwrap_or(header.radius_mm),
            blocks: Blocks::new(gpu, Purpose::Material, "blocks of a kernel", blocks),
            tail,
        };
        Ok((material, fill))
    }

    /// Header of the file: terms, taps, radius and refractive index.
    #[must_use]
    pub fn header(&self) -> &KernelHeader {
        &self.header
    }

    /// Bytes of blocks and tail on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.blocks.bytes() + self.tail.texture.bytes()
    }

    /// Distance of the innermost tap from the centre in mm.
    pub(crate) fn narrowest_mm(&self) -> f32 {
        self.narrowest_mm
    }

    /// Number of terms.
    pub(crate) fn terms(&self) -> usize {
        self.header.terms.into()
    }

    /// Block of the profile.
    pub(crate) fn profile(&self) -> BindingResource<'_> {
        self.blocks.block(0)
    }

    /// Tail of the profile.
    pub(crate) fn tail(&self) -> BindingResource<'_> {
        BindingResource::TextureView(&self.tail.view)
    }

    /// Blocks of a term, along rows and along columns.
    pub(crate) fn term(&self, term: usize) -> [BindingResource<'_>; 2] {
        [0, 1].map(|axis| self.blocks.block(1 + 2 * term + axis))
    }
}
