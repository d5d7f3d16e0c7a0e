//! The path of BTFs: one pass, once it is known what lights see.

use subsurf_shaders::uniform::BtfFiltering;
use subsurf_shaders::{BtfStorage, source};
use wgpu::{BindGroup, Buffer, TextureFormat};

use super::common::{COMMON, encoding_of};
use super::mesh_pass::MeshPass;
use crate::asset::{BtfMaterial, btf_slots};
use crate::error::{Error, Result};
use crate::gpu::{Gpu, Slot, Tracked};

/// How BTFs are looked up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BtfOptions {
    /// Which texels a pixel shows.
    pub filtering: BtfFiltering,
    /// Samples of light from all around for a pixel, at most 1024; grain falls with their square root. None leaves that
    /// light out. Images, which say nothing of how to sample them, get four times as many, by their cosine.
    pub samples: u32,
}

/// Most samples of light from all around for a pixel.
const MAX_SAMPLES: u32 = 1_024;

impl Default for BtfOptions {
    fn default() -> Self {
        Self { filtering: BtfFiltering::Trilinear, samples: 8 }
    }
}

/// Its pipeline.
#[derive(Debug)]
pub(crate) struct Passes {
    storage: BtfStorage,
    pub(crate) shade: MeshPass,
}

/// What is bound for one frame.
#[derive(Debug)]
pub(crate) struct Buffers {
    #[expect(dead_code, reason = "kept in the ledger as long as the device has it")]
    texture: Tracked<Buffer>,
    pub(crate) shade: BindGroup,
}

impl Passes {
    pub(crate) fn new(
        gpu: &Gpu,
        storage: BtfStorage,
        options: BtfOptions,
        format: TextureFormat,
        samples: u32,
    ) -> Result<Self> {
        let [block, texture] = btf_slots(storage);
        let of_btf = [block, texture, Slot::Uniform];
        let shader = source::shade_btf(encoding_of(format), storage, options.samples > 0);
        Ok(Self { storage, shade: MeshPass::textured(gpu, shader, "shade", &[&COMMON, &of_btf], &[format], samples)? })
    }
}

impl Buffers {
    pub(crate) fn new(
        gpu: &Gpu,
        passes: &Passes,
        material: &BtfMaterial,
        number: usize,
        options: BtfOptions,
    ) -> Result<Self> {
        material.expect(passes.storage)?;
        let count = material.textures().len();
        let missing = || Error::Device(format!("material {number} of a BTF of {count}; they are counted from 0"));
        let samples = options.samples.min(MAX_SAMPLES)
            * match passes.storage {
                BtfStorage::Nested => 1,
                BtfStorage::Images => 4,
            };
        let block = material.textures().get(number).ok_or_else(missing)?.drawn(options.filtering, samples);
        let texture = gpu.uniform("BTF texture", &block);
        let [of_material, pixels] = material.resources();
        Ok(Self { shade: passes.shade.bind(gpu, 1, &[of_material, pixels, texture.as_entire_binding()])?, texture })
    }
}
