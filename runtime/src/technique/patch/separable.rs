//! Separable blurs on flat patches: a cascade of Gaussians from weighted irradiance to exitance.

use std::sync::Arc;

use subsurf_shaders::passes::{Choice, table};
use subsurf_shaders::uniform::PatchDomain;
use wgpu::{BindGroup, BindingResource, CommandEncoder, CommandEncoderDescriptor};

use super::surface::{Exitance, PatchLight};
use crate::asset::SeparableMaterial;
use crate::error::Result;
use crate::gpu::{FullscreenPass, Gpu, Purpose, TextureSpec};
use crate::technique::cascade::{BlurPasses, Cascade, CascadeMaps};

/// Pipelines of separable blurs on flat patches of L terms; made once.
#[derive(Debug)]
pub struct SeparableRenderer {
    terms: usize,
    first: FullscreenPass,
    blur: BlurPasses,
    last: FullscreenPass,
}

/// Patch under a light, ready to be drawn any number of times.
#[derive(Debug)]
pub struct SeparablePatch {
    cascade: Cascade,
    first: BindGroup,
    exitance: Exitance,
}

impl SeparableRenderer {
    /// Compiles the passes.
    ///
    /// # Errors
    /// [`Error::Device`](crate::Error::Device) if the driver refuses them.
    pub fn new(gpu: &Gpu, terms: usize) -> Result<Self> {
        let choice = Choice::Terms(terms);
        let target = gpu.target_texture_format();
        Ok(Self {
            terms,
            first: FullscreenPass::new(gpu, table::BLUR_PATCH_FIRST.with(choice), &vec![target; terms])?,
            blur: BlurPasses::new(gpu, [&table::BLUR_PATCH, &table::SUM_PATCH], terms)?,
            last: FullscreenPass::new(gpu, table::BLUR_PATCH_LAST.with(choice), &[target])?,
        })
    }

    /// Makes room for the maps of a patch.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::Error::Usage) if the material has another number of terms, [`Error::Unsupported`](crate::Error::Unsupported) if it is too large.
    pub fn prepare(&self, gpu: &Gpu, material: &SeparableMaterial, light: &PatchLight) -> Result<SeparablePatch> {
        light.expect([material.header().width, material.header().height])?;
        self.bind(gpu, material, light)
    }

    /// The same for light of one texel for each pixel, or of one for all.
    pub(crate) fn bind(&self, gpu: &Gpu, material: &SeparableMaterial, light: &PatchLight) -> Result<SeparablePatch> {
        material.expect(self.terms)?;
        let header = material.header();
        let size = [header.width, header.height];
        let domain = gpu.uniform(Purpose::Frame, "patch", &PatchDomain::new(header));
        let domain = domain.as_entire_binding();
        let maps = Arc::new(CascadeMaps::new(gpu, size, self.terms)?);
        let texture = BindingResource::TextureView;
        let basis = texture(&material.layers.all);
        let last = (&self.last, Some(basis.clone()));
        let cascade = Cascade::new(gpu, &self.blur, last, material, &domain, &maps)?;
        let [rows, _] = &material.stages()[0];
        let of_first = [rows.as_entire_binding(), domain, basis, texture(light.view())];
        let surface = gpu.texture(&TextureSpec::target("exitance", size, gpu.target_texture_format()))?;
        Ok(SeparablePatch {
            first: self.first.bind(gpu, 0, &of_first)?,
            cascade,
            exitance: Exitance::new(surface, size),
        })
    }

    /// Draws the exitance of the whole patch.
    ///
    /// # Errors
    /// [`Error::Device`](crate::Error::Device) if the device is lost.
    pub fn draw<'a>(&self, gpu: &Gpu, patch: &'a SeparablePatch) -> Result<&'a Exitance> {
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            let exitance = self.record(&mut encoder, patch);
            gpu.queue.submit([encoder.finish()]);
            exitance
        })
    }

    /// Records all passes, to the exitance of the whole patch.
    pub(crate) fn record<'a>(&self, encoder: &mut CommandEncoder, patch: &'a SeparablePatch) -> &'a Exitance {
        let first = Some((&self.first, &patch.first));
        let last = (&self.last, &[patch.exitance.view()][..]);
        patch.cascade.record(encoder, patch.exitance.size, &self.blur, first, last, &mut |_, _| {});
        &patch.exitance
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
