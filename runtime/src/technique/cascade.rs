//! Cascade of Gaussian blurs over weighted irradiance maps.

use std::sync::Arc;

use subsurf_shaders::passes::{Choice, Pass};
use wgpu::{BindGroup, BindingResource, CommandEncoder, TextureView};

use super::bindings::Lap;
use crate::asset::SeparableMaterial;
use crate::error::Result;
use crate::gpu::{FullscreenPass, Gpu, HALF, Rows, Surface2d, TextureSpec, layer_of, layers_of};

/// L maps in one texture: layers of an array, a plain one if L = 1.
#[derive(Debug)]
pub(crate) struct Maps {
    surface: Surface2d,
    /// View of all maps, to read.
    pub(crate) all: TextureView,
    /// View of each map, to draw to.
    pub(crate) layers: Vec<TextureView>,
}

impl Maps {
    fn new(gpu: &Gpu, label: &'static str, size: [u32; 2], terms: usize) -> Result<Self> {
        let spec = Self::spec(label, size, terms, gpu.target_texture_format());
        let surface = gpu.texture(&spec)?;
        let layers = (0..spec.layers).map(|layer| layer_of(&surface, layer)).collect();
        let all = if spec.layers == 1 { surface.view.clone() } else { layers_of(&surface) };
        Ok(Self { all, layers, surface })
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
        3 * Maps::spec("", size, terms, HALF).bytes()
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
    last: BindGroup,
}

/// Bind groups of a stage.
#[derive(Debug)]
struct Stage {
    rows: BindGroup,
    columns: BindGroup,
    sum: BindGroup,
}

impl Cascade {
    /// Binds a material to maps. `domain` is the block of the screen, or a sampler that wraps as the patch does; `last` blurs along
    /// columns and adds up, and is bound to `more` besides.
    pub(crate) fn new(
        gpu: &Gpu,
        passes: &BlurPasses,
        (last, more): (&FullscreenPass, Option<BindingResource<'_>>),
        material: &SeparableMaterial,
        domain: &BindingResource<'_>,
        maps: &Arc<CascadeMaps>,
    ) -> Result<Self> {
        let texture = BindingResource::TextureView;
        let blurred = texture(&maps.blurred.all);
        let stages = material.stages().iter().enumerate().map(|(a, [rows, columns])| {
            let (between, before) = (texture(&maps.between(a).all), texture(&maps.sums_before(a).all));
            let [rows, columns] = [rows, columns].map(|block| block.as_entire_binding());
            Ok(Stage {
                rows: passes.blur.bind(gpu, 0, &[rows, domain.clone(), blurred.clone()])?,
                columns: passes.blur.bind(gpu, 0, &[columns.clone(), domain.clone(), between])?,
                sum: passes.sum.bind(gpu, 0, &[columns, domain.clone(), blurred.clone(), before])?,
            })
        });
        let stages: Vec<Stage> = stages.collect::<Result<_>>()?;
        let a = stages.len() - 1;
        let [_, columns] = &material.stages()[a];
        let (between, before) = (texture(&maps.between(a).all), texture(&maps.sums_before(a).all));
        let of_last = [columns.as_entire_binding(), domain.clone(), between, before];
        let of_last: Vec<_> = of_last.into_iter().chain(more).collect();
        Ok(Self { maps: maps.clone(), last: last.bind(gpu, 0, &of_last)?, stages })
    }

    /// Bytes of the maps on the device.
    pub(crate) fn bytes(&self) -> u64 {
        let maps = [&self.maps.blurred, &self.maps.turns[0], &self.maps.turns[1]];
        maps.iter().map(|maps| maps.surface.texture.bytes()).sum()
    }

    /// Records all stages over `size` texels of the maps: `last` draws to `targets` in the end. With `first`, another pass takes the place of the first along rows.
    pub(crate) fn record(
        &self,
        encoder: &mut CommandEncoder,
        size: [u32; 2],
        passes: &BlurPasses,
        first: Option<(&FullscreenPass, &BindGroup)>,
        (last, targets): (&FullscreenPass, &[&TextureView]),
        lap: Lap<'_>,
    ) {
        let all = Rows::all(size);
        let mut draw = |pass: &FullscreenPass, group: &BindGroup, targets: &[&TextureView]| {
            pass.record(encoder, targets, &[group], all);
            lap(pass.name(), encoder);
        };
        for (a, stage) in self.stages.iter().enumerate() {
            let [blurred, between] =
                [&self.maps.blurred, self.maps.between(a)].map(|maps| maps.layers.iter().collect());
            let (blurred, between): (Vec<_>, Vec<_>) = (blurred, between);
            match first {
                Some((pass, group)) if a == 0 => draw(pass, group, &between),
                _ => draw(&passes.blur, &stage.rows, &between),
            }
            if a + 1 == self.stages.len() {
                draw(last, &self.last, targets);
            } else {
                draw(&passes.blur, &stage.columns, &blurred);
                draw(&passes.sum, &stage.sum, &between);
            }
        }
    }
}
