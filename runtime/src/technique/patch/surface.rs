//! Irradiance on flat patches, and exitance from them.

use subsurf_decoder::bssrdf::Addressing;
use wgpu::{AddressMode, Sampler, SamplerDescriptor, TextureFormat, TextureView};

use crate::error::{Error, Result};
use crate::gpu::{Gpu, Purpose, Surface2d, TextureSpec};

/// Irradiance on a patch, on the device.
#[derive(Debug)]
pub struct PatchLight(Surface2d);

/// Exitance of a region of a patch, on the device, as half floats or their bits.
#[derive(Debug)]
pub struct Exitance {
    pub(super) surface: Surface2d,
    pub(super) size: [u32; 2],
}

/// Rectangle of a patch, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Column and row of the upper left pixel.
    pub origin: [u32; 2],
    /// Width and height.
    pub size: [u32; 2],
}

impl PatchLight {
    /// Uploads irradiance that has entered the material, one linear rgb value per pixel of a patch of `size`, row by row.
    ///
    /// # Errors
    /// [`crate::Error::Unsupported`] if the patch is too large for a texture.
    pub fn upload(gpu: &Gpu, size: [u32; 2], irradiance: &[[f32; 3]]) -> Result<Self> {
        let texels: Vec<[f32; 4]> = irradiance.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect();
        let table = TextureSpec::table("patch irradiance", size, TextureFormat::Rgba32Float);
        let spec = TextureSpec { purpose: Purpose::Frame, ..table };
        Ok(Self(gpu.filled(&spec, bytemuck::cast_slice(&texels))?))
    }

    /// View of the texture.
    pub(crate) fn view(&self) -> &TextureView {
        &self.0.view
    }

    /// Refuses light of another size than the patch: texels beyond it are not there.
    pub(crate) fn expect(&self, size: [u32; 2]) -> Result<()> {
        let have = [self.0.texture.width(), self.0.texture.height()];
        if have == size {
            return Ok(());
        }
        Err(Error::Usage(format!("light for a patch of {have:?} pixels, the material has {size:?}")))
    }
}

impl Exitance {
    /// Exitance in a texture of `size`.
    pub(crate) fn new(surface: Surface2d, size: [u32; 2]) -> Self {
        Self { surface, size }
    }

    /// View of the texture.
    pub(crate) fn view(&self) -> &TextureView {
        &self.surface.view
    }

    /// Reads the exitance back: linear Rec. 709, row by row.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the device is lost.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<[f32; 3]>> {
        gpu.read_rgb(&self.surface.texture)
    }
}

/// Sampler that does not filter, and wraps as the patch says.
pub(super) fn nearest(gpu: &Gpu, addressing: Addressing) -> Sampler {
    let mode = match addressing {
        Addressing::Clamp => AddressMode::ClampToEdge,
        Addressing::Repeat => AddressMode::Repeat,
        Addressing::Mirror => AddressMode::MirrorRepeat,
    };
    gpu.device.create_sampler(&SamplerDescriptor {
        label: Some("patch"),
        address_mode_u: mode,
        address_mode_v: mode,
        ..Default::default()
    })
}
