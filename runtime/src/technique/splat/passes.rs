//! Pipelines of splats.

use subsurf_shaders::uniform::MAX_RINGS;
use subsurf_shaders::{Storage, source};
use wgpu::TextureFormat;

use crate::asset::slots;
use crate::error::Result;
use crate::gpu::{CoverPass, Gpu, HALF, Slot, SquarePass};
use crate::technique::common::{COMMON, encoding_of};
use crate::technique::mesh_pass::MeshPass;

/// Pipelines for materials of one storage.
#[derive(Debug)]
pub(crate) struct Passes {
    pub(super) storage: Storage,
    pub(super) view: MeshPass,
    pub(super) reduce: CoverPass,
    pub(super) splat: SquarePass,
    pub(super) collapse: CoverPass,
    pub(super) shade: MeshPass,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, storage: Storage, format: TextureFormat, samples: u32) -> Result<Self> {
        gpu.expect_halves("splats")?;
        let of_view: [&[Slot]; 2] = [&[Slot::Uniform], &[Slot::FilteredLayers, Slot::Sampler]];
        let of_reduce = [Slot::Uniform, Slot::KeptLayers, Slot::KeptLayers, Slot::KeptLayers];
        let of_splat =
            [Slot::Uniform, Slot::FloatLayers, Slot::FloatLayers, Slot::FloatLayers, Slot::Float, Slot::Float];
        let mut of_collapse = vec![Slot::Uniform];
        of_collapse.extend([Slot::Float; 2 + MAX_RINGS]);
        let of_shade = [Slot::FilteredLayers, Slot::Sampler, Slot::Uniform, Slot::Float];
        let splat = source::splat(storage);
        let shade = source::shade_splats(encoding_of(format));
        Ok(Self {
            storage,
            view: MeshPass::new(gpu, source::SURFACE_VIEW, "view", &of_view, &[HALF; 3], 1)?,
            reduce: CoverPass::new(gpu, source::REDUCE, "reduce", &[&of_reduce], &[HALF; 3])?,
            splat: SquarePass::new(gpu, splat, "splat", &[slots(storage), &of_splat], HALF)?,
            collapse: CoverPass::new(gpu, source::COLLAPSE, "collapse", &[&of_collapse], &[HALF])?,
            shade: MeshPass::new(gpu, shade, "shade", &[&COMMON, &of_shade], &[format], samples)?,
        })
    }
}
