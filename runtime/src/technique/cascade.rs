//! Cascade of Gaussian blurs over weighted irradiance maps.

use std::sync::Arc;

use subsurf_shaders::passes::{Choice, Pass};
use wgpu::{BindGroup, BindingResource, CommandEncoder, TextureView};

use super::bindings::Lap;
use crate::asset::SeparableMaterial;
use crate::error::Result;
use crate::gpu::{FullscreenPass, Gpu, HALF, Rows, Surface2d, TextureSpec, layer_of};

/// L maps in one texture: layers of an array, a plain one if L = 1.
#[derive(Debug)]
pub(crate) struct Maps {
    pub(crate) surface: Surface2d,
    /// View of each map, to draw to.
    pub(crate) layers: Vec<TextureView>,
}

impl Maps {
    pub(crate) fn new(gpu: &Gpu, label: &'static str, size: [u32; 2], terms: usize) -> Result<Self> {
        let spec = Self::spec(label, size, terms, gpu.target_texture_format());
        let surface = gpu.texture(&spec)?;
        let layers = (0..spec.layers).map(|layer| layer_of(&surface, layer)).collect();
        Ok(Self { layers, surface })
    }

    /// Bytes on the device.
    pub(crate) fn bytes_of(size: [u32; 2], terms: usize) -> u64 {
        Self::spec("", size, terms, HALF).bytes()
    }

    /// All maps, to read.
    pub(crate) fn all(&self) -> BindingResource<'_> {
        BindingResource::TextureView(&self.surface.view)
    }

    fn spec(label: &'static str, size: [u32; 2], terms: usize, format: wgpu::TextureFormat) -> TextureSpec {
        let layers = u32::try_from(terms).unwrap_or(u32::MAX);
        TextureSpec { layers, ..TextureSpec::target(label, size, format) }
    }
}

/// Passes of the cascade, for maps that lie on a patch or on the screen.
#[derive(Debug)]
pub(crate) struct BlurPasses {
    /// Blur along rows, or along columns.
    blur: FullscreenPass,
    /// Sum over the stages so far.
    sum: FullscreenPass,
}

impl BlurPasses {
    /// Compiles the passes that blur and that sum, for L = `terms`.
    pub(crate) fn new(gpu: &Gpu, [blur, sum]: [&'static Pass; 2], terms: usize) -> Result<Self> {
        let targets = vec![gpu.target_texture_format(); terms];
        let pass = |pass: &'static Pass| FullscreenPass::new(gpu, pass.with(Choice::Terms(terms)), &targets);
        Ok(Self { blur: pass(blur)?, sum: pass(sum)? })
    }
}

/// Maps of one size that a cascade blurs.
///
/// Each stage blurs the first maps along rows into a free texture and back along columns, then writes their sum with that of the stages
/// before into the free one, which leaves the other free. The last stage writes its sum over the first maps.
#[derive(Debug)]
pub(crate) struct CascadeMaps {
    /// Maps c_l E, blurred stage by stage; in the end the sums S_m.
    blurred: Maps,
    /// By turns: what is between rows and columns, and the sums of the stages before.
    turns: [Maps; 2],
}

impl CascadeMaps {
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2], terms: usize) -> Result<Self> {
        let map = |label| Maps::new(gpu, label, size, terms);
        Ok(Self {
            blurred: map("weighted irradiance")?,
            turns: [map("blurred along rows, or sums of stages")?, map("sums of stages, or blurred along rows")?],
        })
    }

    /// Bytes on the device.
    pub(crate) fn bytes_of(size: [u32; 2], terms: usize) -> u64 {
        3 * Maps::bytes_of(size, terms)
    }

    /// Maps c_l E before the first stage.
    pub(crate) fn irradiance(&self) -> &Maps {
        &self.blurred
    }

    /// Sums S_m before the first stage: light of the pass that makes the maps, on the screen.
    pub(crate) fn begun_sums(&self) -> &Maps {
        self.sums_before(0)
    }

    /// Sums S_m after the last stage, where the last pass draws them.
    pub(crate) fn sums(&self) -> &Maps {
        &self.blurred
    }

    /// Maps between rows and columns of a stage.
    pub(crate) fn between(&self, stage: usize) -> &Maps {
        &self.turns[stage % 2]
    }

    /// All maps, free until the first stage; the first of them is free until that has blurred along rows.
    pub(crate) fn in_turns(&self) -> [&Maps; 3] {
        [&self.turns[0], &self.blurred, &self.turns[1]]
    }

    /// Sums S_m before a stage.
    pub(crate) fn sums_before(&self, stage: usize) -> &Maps {
        &self.turns[(stage + 1) % 2]
    }
}

/// Bind groups of the passes that blur maps by the Gaussians of a material, and of the pass that ends them.
#[derive(Debug)]
pub(crate) struct Cascade {
    pub(crate) maps: Arc<CascadeMaps>,
    stages: Vec<Stage>,
}

/// Bind groups of a stage.
#[derive(Debug)]
struct Stage {
    rows: BindGroup,
    columns: BindGroup,
    sum: BindGroup,
    /// Of the pass that blurs along columns and adds up, should the stage be the last.
    last: BindGroup,
}

impl Cascade {
    /// Binds a material to maps. `domain` is the block of the screen, or of the patch; `first` takes the place of the first bind
    /// group along rows; `last` blurs along columns and adds up, and is bound to `more` besides.
    pub(crate) fn new(
        gpu: &Gpu,
        passes: &BlurPasses,
        first: Option<BindGroup>,
        (last, more): (&FullscreenPass, Option<BindingResource<'_>>),
        material: &SeparableMaterial,
        domain: &BindingResource<'_>,
        maps: &Arc<CascadeMaps>,
    ) -> Result<Self> {
        let blurred = maps.blurred.all();
        let mut first = first;
        let stages = (0..material.gaussians()).map(|a| {
            let [rows, columns] = material.stage(a);
            let (between, before) = (maps.between(a).all(), maps.sums_before(a).all());
            let rows = match first.take() {
                Some(group) => group,
                None => passes.blur.bind(gpu, 0, &[rows, domain.clone(), blurred.clone()])?,
            };
            let of_columns = [columns.clone(), domain.clone(), between.clone()];
            let of_sum = [columns.clone(), domain.clone(), blurred.clone(), before.clone()];
            let of_last: Vec<_> = [columns, domain.clone(), between, before].into_iter().chain(more.clone()).collect();
            Ok(Stage {
                rows,
                columns: passes.blur.bind(gpu, 0, &of_columns)?,
                sum: passes.sum.bind(gpu, 0, &of_sum)?,
                last: last.bind(gpu, 0, &of_last)?,
            })
        });
        Ok(Self { stages: stages.collect::<Result<_>>()?, maps: maps.clone() })
    }

    /// Number of stages.
    pub(crate) fn count(&self) -> usize {
        self.stages.len()
    }

    /// Bytes of the maps on the device.
    pub(crate) fn bytes(&self) -> u64 {
        let maps = [&self.maps.blurred, &self.maps.turns[0], &self.maps.turns[1]];
        maps.iter().map(|maps| maps.surface.texture.bytes()).sum()
    }

    /// Records the first `stages` stages over `size` texels of the maps: `last` draws to `targets` in the end. With `first`, another
    /// pass takes the place of the first along rows, to which its bind group was given.
    pub(crate) fn record(
        &self,
        encoder: &mut CommandEncoder,
        (size, stages): ([u32; 2], usize),
        passes: &BlurPasses,
        first: Option<&FullscreenPass>,
        (last, targets): (&FullscreenPass, &[&TextureView]),
        lap: Lap<'_>,
    ) {
        let all = Rows::all(size);
        let mut draw = |pass: &FullscreenPass, group: &BindGroup, targets: &[&TextureView]| {
            pass.record(encoder, targets, &[group], all);
            lap(pass.name(), encoder);
        };
        let mut first = first;
        let stages = stages.min(self.stages.len());
        for (a, stage) in self.stages[..stages].iter().enumerate() {
            let [blurred, between] =
                [&self.maps.blurred, self.maps.between(a)].map(|maps| maps.layers.iter().collect());
            let (blurred, between): (Vec<_>, Vec<_>) = (blurred, between);
            draw(first.take().unwrap_or(&passes.blur), &stage.rows, &between);
            if a + 1 == stages {
                draw(last, &stage.last, targets);
            } else {
                draw(&passes.blur, &stage.columns, &blurred);
                draw(&passes.sum, &stage.sum, &between);
            }
        }
    }
}
