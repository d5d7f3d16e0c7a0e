//! The technique of BTFs: one pass, once it is known what lights see.

use std::sync::Arc;

use subsurf_scene::Scene;
use subsurf_shaders::BtfLayout;
use subsurf_shaders::passes::{Choice, table};
use subsurf_shaders::uniform::{self, BtfFiltering};
use wgpu::{BindGroup, Buffer, TextureFormat};

use super::common::Common;
use super::drawable::Drawable;
use super::mesh_pass::MeshPass;
use super::pipelines::{Bindings, Pipelines, wrong_drawable};
use super::tsm::TranslucentShadowMaps;
use crate::error::{Error, Result};
use crate::frame::plan::Plan;
use crate::gpu::{Gpu, Tracked};

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
    layout: BtfLayout,
    options: BtfOptions,
    shade: MeshPass,
}

/// Bind group of one material of a BTF.
#[derive(Debug)]
struct Bound {
    #[expect(dead_code, reason = "kept in the ledger as long as the device has it")]
    texture: Tracked<Buffer>,
    shade: BindGroup,
}

impl Passes {
    pub(crate) fn new(
        gpu: &Gpu,
        layout: BtfLayout,
        options: BtfOptions,
        format: TextureFormat,
        samples: u32,
    ) -> Result<Self> {
        let variant = table::SHADE_BTF.with(Choice::LitBtf(layout, options.samples > 0));
        let shade = MeshPass::textured_picture(gpu, variant, format, samples)?;
        Ok(Self { layout, options, shade })
    }
}

impl Pipelines for Passes {
    fn shade(&self) -> &MeshPass {
        &self.shade
    }

    fn bind(
        self: Arc<Self>,
        gpu: &Gpu,
        drawable: &Drawable<'_>,
        _common: &Common,
        _lights: &TranslucentShadowMaps,
        _plan: &Plan,
    ) -> Result<Box<dyn Bindings>> {
        let Drawable::Btf { mesh, material, number } = drawable else {
            return Err(wrong_drawable());
        };
        mesh.expect_tangents()?;
        material.expect(self.layout)?;
        let count = material.textures().len();
        let missing = || Error::Device(format!("material {number} of a BTF of {count}; they are counted from 0"));
        let samples = self.options.samples.min(MAX_SAMPLES)
            * match self.layout {
                BtfLayout::Nested => 1,
                BtfLayout::Images => 4,
            };
        let block = material.textures().get(*number).ok_or_else(missing)?.drawn(self.options.filtering, samples);
        let texture = gpu.uniform("BTF texture", &block);
        let [of_material, pixels] = material.resources();
        let shade = self.shade.bind(gpu, 1, &[of_material, pixels, texture.as_entire_binding()])?;
        Ok(Box::new(Bound { texture, shade }))
    }
}

impl Bindings for Bound {
    fn update(
        &mut self,
        _gpu: &Gpu,
        drawable: &Drawable<'_>,
        _scene: &Scene,
        _block: &uniform::Scene,
        _plan: &Plan,
    ) -> Result<()> {
        match drawable {
            Drawable::Btf { mesh, .. } => mesh.expect_tangents(),
            _ => Err(wrong_drawable()),
        }
    }

    fn shade(&self) -> &BindGroup {
        &self.shade
    }
}
