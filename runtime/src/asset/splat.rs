//! Materials for splats on the device.

use subsurf_decoder::Bssrdf;
use subsurf_scene::MeanProfile;
use subsurf_shaders::Rgb;

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
    /// What softened distances take from samples is given back by it.
    pub(crate) mean: MeanProfile,
}

impl SplatMaterial {
    /// Makes room for the albedo beside the planes of a file; it has to be projected.
    ///
    /// # Errors
    /// [`Error::Unsupported`](crate::Error::Unsupported) if the device takes no texture of that size.
    pub(crate) fn new(gpu: &Gpu, material: &Bssrdf<'_>, planes: BssrdfPlanes) -> Result<Self> {
        let albedo = PatchLayers::new(gpu, material.header(), 1)?;
        Ok(Self { planes, mean: MeanProfile::of(material), albedo })
    }

    /// Planes of the file.
    #[must_use]
    pub fn planes(&self) -> &BssrdfPlanes {
        &self.planes
    }

    /// Reads a mipmap level of the albedo under uniform light back: linear Rec. 709, row by row.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::Error::Usage) if there is none; [`Error::Device`](crate::Error::Device) if the device is lost.
    pub fn read_albedo(&self, gpu: &Gpu, level: u32) -> Result<Vec<Rgb>> {
        self.albedo.read(gpu, 0, level)
    }

    /// Bytes of planes and albedo on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.planes.gpu_bytes() + self.albedo.bytes()
    }
}
