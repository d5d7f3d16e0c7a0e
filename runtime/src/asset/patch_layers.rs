//! Filtered values over a patch on the device, with mipmap levels.

use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader};
use subsurf_shaders::Rgb;
use wgpu::{
    AddressMode, BindingResource, FilterMode, MipmapFilterMode, Sampler, SamplerDescriptor, TextureFormat,
    TextureUsages,
};

use crate::error::{Error, Result};
use crate::gpu::{Gpu, Surface2d, TextureSpec};

/// Array of filtered values over a patch, rgb, with mipmap levels, as half floats.
///
/// Indices of base materials cannot be filtered; albedos and coefficients can.
#[derive(Debug)]
pub(crate) struct PatchLayers {
    pub(crate) surface: Surface2d,
    /// Number of layers that have a meaning.
    pub(crate) count: u32,
    /// Sampler that filters and wraps as the patch does.
    pub(crate) sampler: Sampler,
}

impl PatchLayers {
    /// Makes room for `count` layers over the patch, which have to be projected.
    ///
    /// # Errors
    /// [`crate::Error::Unsupported`] if the device takes no texture of that size.
    pub(crate) fn new(gpu: &Gpu, header: &BssrdfHeader, count: usize) -> Result<Self> {
        let size = [header.width, header.height];
        let count = u32::try_from(count).unwrap_or(u32::MAX);
        let levels = size[0].max(size[1]).ilog2() + 1;
        let spec = TextureSpec::layered("layers of the patch", size, count, TextureFormat::Rgba16Float);
        let usage = spec.usage | TextureUsages::COPY_SRC;
        let surface = gpu.texture(&TextureSpec { levels, usage, ..spec })?;
        Ok(Self { surface, count, sampler: sampler(gpu, header.addressing) })
    }

    /// All layers and levels, and the sampler.
    pub(crate) fn resources(&self) -> [BindingResource<'_>; 2] {
        [BindingResource::TextureView(&self.surface.view), BindingResource::Sampler(&self.sampler)]
    }

    /// Reads a mipmap level of a layer back: linear Rec. 709, row by row.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none; [`Error::Device`] if the device is lost.
    pub(crate) fn read(&self, gpu: &Gpu, layer: usize, level: u32) -> Result<Vec<Rgb>> {
        let (layers, levels) = (self.count, self.surface.texture.mip_level_count());
        let found = u32::try_from(layer).ok().filter(|layer| *layer < layers && level < levels);
        let missing = || Error::Usage(format!("level {level} of layer {layer}: {layers} layers have {levels} levels"));
        gpu.read_rgb_level(&self.surface.texture, found.ok_or_else(missing)?, level)
    }

    /// Bytes on the device.
    pub(crate) fn bytes(&self) -> u64 {
        self.surface.texture.bytes()
    }
}

/// Sampler that is linear between texels and levels. A patch that clamps is mirrored: its border would be drawn out otherwise.
fn sampler(gpu: &Gpu, addressing: Addressing) -> Sampler {
    let mode = match addressing {
        Addressing::Repeat => AddressMode::Repeat,
        Addressing::Clamp | Addressing::Mirror => AddressMode::MirrorRepeat,
    };
    gpu.device.create_sampler(&SamplerDescriptor {
        label: Some("patch"),
        address_mode_u: mode,
        address_mode_v: mode,
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        mipmap_filter: MipmapFilterMode::Linear,
        ..Default::default()
    })
}
