//! A material for splatting on the device.

use subsurf_decoder::Bssrdf;
use subsurf_shaders::cpu::Rgb;
use subsurf_shaders::separable::{Factors, softened};

use super::bssrdf::Material;
use super::patch_layers::PatchLayers;
use super::separable::{albedo, whole};
use crate::error::Result;
use crate::gpu::Gpu;

/// A material for splatting: its planes, and its albedo under uniform light.
#[derive(Debug)]
pub struct SplatMaterial {
    pub(crate) planes: Material,
    pub(crate) albedo: PatchLayers,
    /// What softening takes, by [`softened`].
    pub(crate) softened: [Rgb; 8],
}

impl SplatMaterial {
    /// Uploads the planes of a file as they stand in it, and the albedo that its factors give.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size; [`Error::Device`] if some factors are missing.
    pub fn upload(gpu: &Gpu, material: &Bssrdf<'_>, factors: &Factors) -> Result<Self> {
        whole(factors)?;
        Ok(Self {
            planes: Material::upload(gpu, material)?,
            softened: softened(material),
            albedo: PatchLayers::upload(gpu, material.header(), vec![albedo(factors)])?,
        })
    }

    /// The planes alone.
    #[must_use]
    pub fn planes(&self) -> &Material {
        &self.planes
    }

    /// Bytes on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.planes.gpu_bytes() + self.albedo.bytes()
    }
}
