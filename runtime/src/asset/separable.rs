//! Materials for separable blurs on the device.

use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_shaders::separable::BasisNumbers;
use subsurf_shaders::{Rgb, uniform};
use wgpu::Buffer;

use super::patch_layers::PatchLayers;
use crate::error::{Error, Result};
use crate::gpu::{Gpu, Purpose, Tracked};

/// Separable material on the device: coefficients c_l and albedo over the patch, and blocks of the cascade of Gaussians.
#[derive(Debug)]
pub struct SeparableMaterial {
    header: BssrdfHeader,
    terms: usize,
    /// Layers c_l, l < L, and the albedo under uniform light.
    pub(crate) layers: PatchLayers,
    /// Blocks along rows and along columns, for each Gaussian a.
    stages: Vec<[Tracked<Buffer>; 2]>,
    transmission: Tracked<Buffer>,
    narrowest_pixels: f32,
}

impl SeparableMaterial {
    /// Makes room for a basis, and its blocks; the layers have to be projected.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub(crate) fn new(gpu: &Gpu, basis: &BasisNumbers) -> Result<Self> {
        let terms = basis.size().terms;
        let stages = uniform::BlurStage::cascade(basis);
        Ok(Self {
            header: *basis.header(),
            terms,
            layers: PatchLayers::new(gpu, basis.header(), terms + 1)?,
            transmission: gpu.uniform(Purpose::Material, "transmission", &uniform::Transmission::new(basis)),
            narrowest_pixels: basis.sigmas().first().copied().unwrap_or(1.0),
            stages: stages
                .iter()
                .map(|axes| axes.map(|block| gpu.uniform(Purpose::Material, "stage", &block)))
                .collect(),
        })
    }

    /// BssrdfHeader of the file: size, pitch and window of the patch.
    #[must_use]
    pub fn header(&self) -> &BssrdfHeader {
        &self.header
    }

    /// Number of terms L, 1 or 2.
    #[must_use]
    pub fn terms(&self) -> usize {
        self.terms
    }

    /// Reads a mipmap level of a layer back, row by row: coefficients c_l for l < L, the albedo under uniform light for l = L;
    /// linear Rec. 709.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none; [`Error::Device`] if the device is lost.
    pub fn read(&self, gpu: &Gpu, l: usize, level: u32) -> Result<Vec<Rgb>> {
        self.layers.read(gpu, l, level)
    }

    /// Refuses a material of another number of terms than a pass was built for.
    pub(crate) fn expect(&self, terms: usize) -> Result<()> {
        if self.terms == terms {
            return Ok(());
        }
        Err(Error::Usage(format!("this renderer draws L = {terms}, the material has L = {}", self.terms)))
    }

    /// Bytes of layers and blocks on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.layers.bytes() + self.stages.iter().flatten().chain([&self.transmission]).map(Tracked::bytes).sum::<u64>()
    }

    /// Block of the weights of all Gaussians, for light that passes through thin parts.
    pub(crate) fn transmission(&self) -> &Buffer {
        &self.transmission
    }

    /// Standard deviation of the narrowest Gaussian, in pixels of the patch.
    pub(crate) fn narrowest_pixels(&self) -> f32 {
        self.narrowest_pixels
    }

    /// Blocks along rows and along columns, for each Gaussian.
    pub(crate) fn stages(&self) -> &[[Tracked<Buffer>; 2]] {
        &self.stages
    }
}
