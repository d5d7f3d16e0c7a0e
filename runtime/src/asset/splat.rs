//! Materials for splats on the device.

use subsurf_decoder::Bssrdf;
use subsurf_shaders::separable::albedo;
use subsurf_shaders::{Rgb, softening_gain};

use super::bssrdf::BssrdfPlanes;
use super::patch_layers::PatchLayers;
use crate::error::Result;
use crate::gpu::Gpu;

/// Material for splats on the device: the planes of its file, and its albedo under uniform light.
#[derive(Debug)]
pub struct SplatMaterial {
    /// Planes of the file.
    pub(crate) planes: BssrdfPlanes,
    /// One layer: albedo under uniform light.
    pub(crate) albedo: PatchLayers,
    /// Factors that give back the light that softened distances take, by [`softening_gain`].
    pub(crate) softening_gain: [Rgb; 8],
}

impl SplatMaterial {
    /// Uploads the planes of a file as they stand in it, and its albedo, [`albedo`].
    ///
    /// # Errors
    /// [`Error::Unsupported`](crate::Error::Unsupported) if the device takes no texture of that size.
    pub fn upload(gpu: &Gpu, material: &Bssrdf<'_>) -> Result<Self> {
        Ok(Self {
            planes: BssrdfPlanes::upload(gpu, material)?,
            softening_gain: softening_gain(material),
            albedo: PatchLayers::upload(gpu, material.header(), vec![albedo(material)])?,
        })
    }

    /// Planes of the file.
    #[must_use]
    pub fn planes(&self) -> &BssrdfPlanes {
        &self.planes
    }

    /// Bytes of planes and albedo on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.planes.gpu_bytes() + self.albedo.bytes()
    }
}
