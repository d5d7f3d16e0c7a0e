//! Separable blurs on flat patches: a cascade of Gaussians from weighted irradiance to exitance.

use std::sync::Arc;

use subsurf_shaders::passes::{Choice, table};
use wgpu::{BindGroup, BindingResource, CommandEncoder, CommandEncoderDescriptor, TextureView};

use super::surface::{Exitance, PatchLight};
use crate::asset::SeparableMaterial;
use crate::error::Result;
use crate::gpu::{FullscreenPass, Gpu, TextureSpec};
use crate::technique::cascade::{BlurPasses, Cascade, CascadeMaps};

/// Pipelines of the cascade on flat patches of L terms, from maps of weighted irradiance to exitance.
#[derive(Debug)]
pub(crate) struct PatchCascade {
    blur: BlurPasses,
    last: FullscreenPass,
}

impl PatchCascade {
    /// Compiles the passes, unless they are.
    pub(crate) fn new(gpu: &Gpu, terms: usize) -> Result<Self> {
        let last = table::BLUR_PATCH_LAST.with(Choice::Terms(terms));
        Ok(Self {
            blur: BlurPasses::new(gpu, [&table::BLUR_PATCH, &table::SUM_PATCH], terms)?,
            last: FullscreenPass::new(gpu, last, &[gpu.target_texture_format()])?,
        })
    }

    /// Binds a material to maps of the size of its patch; `first` is bound to the pass in place of the first along rows.
    pub(crate) fn bind(
        &self,
        gpu: &Gpu,
        first: Option<BindGroup>,
        material: &SeparableMaterial,
        maps: &Arc<CascadeMaps>,
    ) -> Result<Cascade> {
        let coefficients = material.coefficients();
        let last = (&self.last, Some(BindingResource::TextureView(&coefficients)));
        Cascade::new(gpu, &self.blur, first, last, material, &material.domain(), maps)
    }

    /// Records all passes over a patch of `size` pixels, to exitance; another pass takes the place of the first along rows if there
    /// is one.
    pub(crate) fn record(
        &self,
        encoder: &mut CommandEncoder,
        size: [u32; 2],
        first: Option<&FullscreenPass>,
        cascade: &Cascade,
        exitance: &TextureView,
    ) {
        cascade.record(encoder, (size, cascade.count()), &self.blur, first, (&self.last, &[exitance]), &mut |_, _| {});
    }
}

/// Pipelines of separable blurs on flat patches of L terms; made once.
#[derive(Debug)]
pub struct SeparableRenderer {
    terms: usize,
    first: FullscreenPass,
    passes: PatchCascade,
}

/// Patch under a light, ready to be drawn any number of times.
#[derive(Debug)]
pub struct SeparablePatch {
    cascade: Cascade,
    exitance: Exitance,
}

impl SeparableRenderer {
    /// Compiles the passes.
    ///
    /// # Errors
    /// [`Error::Device`](crate::Error::Device) if the driver refuses them.
    pub fn new(gpu: &Gpu, terms: usize) -> Result<Self> {
        let targets = vec![gpu.target_texture_format(); terms];
        let first = FullscreenPass::new(gpu, table::BLUR_PATCH_FIRST.with(Choice::Terms(terms)), &targets)?;
        Ok(Self { terms, first, passes: PatchCascade::new(gpu, terms)? })
    }

    /// Makes room for the maps of a patch.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::Error::Usage) if the material has another number of terms, [`Error::Unsupported`](crate::Error::Unsupported) if it is too large.
    pub fn prepare(&self, gpu: &Gpu, material: &SeparableMaterial, light: &PatchLight) -> Result<SeparablePatch> {
        let size = [material.header().width, material.header().height];
        light.expect(size)?;
        material.expect(self.terms)?;
        let maps = Arc::new(CascadeMaps::new(gpu, size, self.terms)?);
        let coefficients = material.coefficients();
        let [coefficients, irradiance] = [&coefficients, light.view()].map(BindingResource::TextureView);
        let [rows, _] = material.stage(0);
        let first = self.first.bind(gpu, 0, &[rows, material.domain(), coefficients, irradiance])?;
        let surface = gpu.texture(&TextureSpec::target("exitance", size, gpu.target_texture_format()))?;
        Ok(SeparablePatch {
            cascade: self.passes.bind(gpu, Some(first), material, &maps)?,
            exitance: Exitance::new(surface, size),
        })
    }

    /// Draws the exitance of the whole patch.
    ///
    /// # Errors
    /// [`Error::Device`](crate::Error::Device) if the device is lost.
    pub fn draw<'a>(&self, gpu: &Gpu, patch: &'a SeparablePatch) -> Result<&'a Exitance> {
        let exitance = &patch.exitance;
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            self.passes.record(&mut encoder, exitance.size, Some(&self.first), &patch.cascade, exitance.view());
            gpu.queue.submit([encoder.finish()]);
        })?;
        Ok(exitance)
    }
}

impl SeparablePatch {
    /// Exitance that was drawn last.
    #[must_use]
    pub fn into_exitance(self) -> Exitance {
        self.exitance
    }

    /// Bytes of the maps on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.cascade.bytes()
    }
}
