//! Materials for separable blurs on the device.

use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_shaders::Rgb;
use subsurf_shaders::separable::BasisNumbers;
use subsurf_shaders::uniform::{BlurStage, PatchDomain, Transmission};
use wgpu::{BindingResource, TextureView};

use super::patch_layers::PatchLayers;
use crate::error::{Error, Result};
use crate::gpu::{Blocks, Gpu, Purpose, layers_of};

/// Separable material on the device: coefficients c_l and albedo over the patch, and blocks of the cascade of Gaussians.
#[derive(Debug)]
pub struct SeparableMaterial {
    header: BssrdfHeader,
    terms: usize,
    /// Layers c_l, l < L, and the albedo under uniform light.
    pub(crate) layers: PatchLayers,
    /// Blocks of the flat patch, of the transmission, and of the stages: along rows and along columns for each Gaussian a.
    blocks: Blocks,
    /// What the blocks of the stages along rows say.
    stages: Vec<BlurStage>,
    /// Standard deviations of the Gaussians in pixels of the patch, narrowest first.
    sigmas: Vec<f32>,
}

impl SeparableMaterial {
    /// Makes room for a basis, and its blocks; the layers have to be projected.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no texture of that size.
    pub(crate) fn new(gpu: &Gpu, basis: &BasisNumbers) -> Result<Self> {
        let terms = basis.size().terms;
        let (domain, transmission) = (PatchDomain::new(basis.header()), Transmission::new(basis));
        let stages = BlurStage::cascade(basis);
        let blocks = [bytemuck::bytes_of(&domain), bytemuck::bytes_of(&transmission)];
        let blocks = blocks.into_iter().chain(stages.iter().flatten().map(bytemuck::bytes_of));
        Ok(Self {
            header: *basis.header(),
            terms,
            layers: PatchLayers::new(gpu, basis.header(), terms + 1)?,
            blocks: Blocks::new(gpu, Purpose::Material, "blocks of a basis", blocks),
            stages: stages.into_iter().map(|[rows, _]| rows).collect(),
            sigmas: basis.sigmas().to_vec(),
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
        self.layers.bytes() + self.blocks.bytes()
    }

    /// View of the coefficients alone, at full size: what else there is may not be drawn yet.
    pub(crate) fn coefficients(&self) -> TextureView {
        layers_of(&self.layers.surface, self.layers.count - 1, 0)
    }

    /// Block of the weights of all Gaussians, for light that passes through thin parts.
    pub(crate) fn transmission(&self) -> BindingResource<'_> {
        self.blocks.block(1)
    }

    /// Block of the flat patch.
    pub(crate) fn domain(&self) -> BindingResource<'_> {
        self.blocks.block(0)
    }

    /// Standard deviation of the narrowest Gaussian, in pixels of the patch.
    pub(crate) fn narrowest_pixels(&self) -> f32 {
        self.sigmas.first().copied().unwrap_or(1.0)
    }

    /// Standard deviations of the Gaussians in mm, narrowest first.
    pub(crate) fn sigmas_mm(&self) -> impl Iterator<Item = f32> {
        self.sigmas.iter().map(|sigma| sigma * self.header.pitch_mm)
    }

    /// What the blocks of the stages along rows say.
    pub(crate) fn stages(&self) -> &[BlurStage] {
        &self.stages
    }

    /// Number of Gaussians A, each of which is a stage of the cascade.
    pub(crate) fn gaussians(&self) -> usize {
        self.stages.len()
    }

    /// Blocks of stage a, along rows and along columns.
    pub(crate) fn stage(&self, a: usize) -> [BindingResource<'_>; 2] {
        [0, 1].map(|axis| self.blocks.block(2 + 2 * a + axis))
    }
}
