//! The technique of BTFs: one pass, once it is known what lights see.

use std::sync::Arc;

use subsurf_shaders::BtfLayout;
use subsurf_shaders::passes::{Choice, table};
use subsurf_shaders::uniform::BtfFiltering;
use wgpu::{BindGroup, Buffer};

use super::bindings::Bindings;
use super::mesh_pass::MeshPass;
use crate::asset::BtfMaterial;
use crate::error::{Error, Result};
use crate::frame::RuntimeOptions;
use crate::gpu::{Gpu, Purpose, Tracked};

/// Filtering and sampling of BTFs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BtfOptions {
    /// Texels that a pixel shows.
    pub filtering: BtfFiltering,
    /// Samples of light from all around for each pixel, 0 to 1024; grain falls with their square root. 0 leaves that light
    /// out. Images, which have no sampler of their own, get four times as many, drawn by the cosine.
    pub samples: u32,
}

/// Most samples of light from all around for a pixel.
const MAX_SAMPLES: u32 = 1_024;

impl Default for BtfOptions {
    fn default() -> Self {
        Self { filtering: BtfFiltering::Trilinear, samples: 8 }
    }
}

/// Pipeline of BTFs of one layout.
#[derive(Debug)]
pub(crate) struct Passes {
    options: BtfOptions,
    shade: MeshPass,
}

/// Bind group of one material of a BTF.
#[derive(Debug)]
struct Bound {
    passes: Arc<Passes>,
    #[expect(dead_code, reason = "kept in the ledger as long as the device has it")]
    texture: Tracked<Buffer>,
    shade: BindGroup,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, layout: BtfLayout, options: &RuntimeOptions) -> Result<Self> {
        let variant = table::SHADE_BTF.with(Choice::LitBtf(layout, options.btf.samples > 0));
        Ok(Self { options: options.btf, shade: MeshPass::textured_picture(gpu, variant, options)? })
    }

    /// Binds one material of a BTF, by its number.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none of that number.
    pub(crate) fn bind(
        self: &Arc<Self>,
        gpu: &Gpu,
        material: &BtfMaterial,
        number: usize,
    ) -> Result<Box<dyn Bindings>> {
        let count = material.textures().len();
        let missing = || Error::Usage(format!("material {number} of a BTF of {count}; they are counted from 0"));
        let samples = self.options.samples.min(MAX_SAMPLES)
            * match material.layout() {
                BtfLayout::Nested => 1,
                BtfLayout::Images => 4,
            };
        let block = material.textures().get(number).ok_or_else(missing)?.drawn(self.options.filtering, samples);
        let texture = gpu.uniform(Purpose::Frame, "BTF texture", &block);
        let [of_material, pixels] = material.resources();
        let shade = self.shade.bind(gpu, 1, &[of_material, pixels, texture.as_entire_binding()])?;
        Ok(Box::new(Bound { passes: self.clone(), texture, shade }))
    }
}

impl Bindings for Bound {
    fn shade(&self) -> (&MeshPass, &BindGroup) {
        (&self.passes.shade, &self.shade)
    }
}
