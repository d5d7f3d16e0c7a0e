//! Cascade of Gaussian blurs over weighted irradiance maps.

use std::sync::Arc;

use subsurf_shaders::passes::{Choice, Pass};
use wgpu::{BindGroup, BindingResource, CommandEncoder, TextureView};

use crate::asset::SeparableMaterial;
use crate::error::Result;
use crate::gpu::{FullscreenPass, Gpu, HALF, Rows, Surface2d, TextureSpec, layer_of, layers_of};

/// L maps in one array.
#[derive(Debug)]
pub(crate) struct Maps {
    surface: Surface2d,
    /// View of all maps, to read.
    pub(crate) all: TextureView,
    /// View of each map, to draw to.
    pub(crate) layers: Vec<TextureView>,
}

impl Maps {
    pub(crate) fn new(gpu: &Gpu, label: &'static str, size: [u32; 2], terms: usize) -> Result<Self> {
        let count = u32::try_from(terms).unwrap_or(u32::MAX);
        let target = TextureSpec::target(label, size, gpu.target_texture_format());
        let surface = gpu
            .texture(&TextureSpec { usage: target.usage, ..TextureSpec::layered(label, size, count, target.format) })?;
        let layers = (0..count).map(|layer| layer_of(&surface, layer)).collect();
        Ok(Self { all: layers_of(&surface), layers, surface })
    }

    /// Bytes on the device of L maps of `size`.
    pub(crate) fn bytes_of(size: [u32; 2], terms: usize) -> u64 {
        let count = u32::try_from(terms).unwrap_or(u32::MAX);
        TextureSpec::layered("", size, count, HALF).bytes()
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.surface.texture.bytes()
    }
}

/// Passes of the cascade, for maps that lie on a patch or on the screen.
#[derive(Debug)]
pub(crate) struct BlurPasses {
    rows: FullscreenPass,
    columns: FullscreenPass,
}

impl BlurPasses {
    /// Compiles the passes along rows and along columns for L = `terms`.
    pub(crate) fn new(gpu: &Gpu, [rows, columns]: [&'static Pass; 2], terms: usize) -> Result<Self> {
        let targets = vec![gpu.target_texture_format(); 2 * terms];
        Ok(Self {
            rows: FullscreenPass::new(gpu, rows.with(Choice::Terms(terms)), &targets[..terms])?,
            columns: FullscreenPass::new(gpu, columns.with(Choice::Terms(terms)), &targets)?,
        })
    }
}

/// Maps of one size that a cascade blurs.
#[derive(Debug)]
pub(crate) struct CascadeMaps {
    size: [u32; 2],
    /// Maps c_l E, blurred in place stage by stage; and the same between rows and columns.
    pub(crate) irradiance: [Maps; 2],
    /// Sums S_m of the stages before and with this one, by turns.
    sums: [Maps; 2],
}

impl CascadeMaps {
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2], terms: usize) -> Result<Self> {
        let map = |label| Maps::new(gpu, label, size, terms);
        Ok(Self {
            size,
            irradiance: [map("weighted irradiance")?, map("irradiance blurred along rows")?],
            sums: [map("sums of stages")?, map("sums of stages, by turns")?],
        })
    }

    /// Bytes on the device.
    pub(crate) fn bytes_of(size: [u32; 2], terms: usize) -> u64 {
        4 * Maps::bytes_of(size, terms)
    }
}

/// Bind groups of the passes that blur maps by the Gaussians of a material.
#[derive(Debug)]
pub(crate) struct Cascade {
    pub(crate) maps: Arc<CascadeMaps>,
    groups: Vec<[BindGroup; 2]>,
}

impl Cascade {
    /// Binds a material to maps. `domain` is the block of the screen, or that of a patch.
    pub(crate) fn new(
        gpu: &Gpu,
        passes: &BlurPasses,
        material: &SeparableMaterial,
        domain: &BindingResource<'_>,
        maps: &Arc<CascadeMaps>,
    ) -> Result<Self> {
        let CascadeMaps { irradiance, sums, .. } = &**maps;
        let texture = BindingResource::TextureView;
        let groups = material.stages().iter().enumerate().map(|(a, [rows, columns])| {
            let of_rows = [rows.as_entire_binding(), domain.clone(), texture(&irradiance[0].all)];
            let so_far = texture(&sums[(a + 1) % 2].all);
            let of_columns = [columns.as_entire_binding(), domain.clone(), texture(&irradiance[1].all), so_far];
            Ok([passes.rows.bind(gpu, 0, &of_rows)?, passes.columns.bind(gpu, 0, &of_columns)?])
        });
        let groups = groups.collect::<Result<_>>()?;
        Ok(Self { maps: maps.clone(), groups })
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.maps.irradiance.iter().chain(&self.maps.sums).map(Maps::bytes).sum()
    }

    /// Sums S_m before the first stage: light of the pass that makes the maps, on the screen.
    pub(crate) fn begun_sums(&self) -> &Maps {
        &self.maps.sums[1]
    }

    /// Sums S_m after the last stage.
    pub(crate) fn sums(&self) -> &Maps {
        &self.maps.sums[(self.groups.len() + 1) % 2]
    }

    /// Sums S_m before the last stage.
    pub(crate) fn sums_before_last(&self) -> &Maps {
        &self.maps.sums[self.groups.len() % 2]
    }

    /// Records all stages, from the maps to the sums; with `ends`, other passes take the place of the first and the last.
    pub(crate) fn record(&self, encoder: &mut CommandEncoder, passes: &BlurPasses, ends: Option<Ends<'_>>) {
        let CascadeMaps { size, irradiance: [maps, between], sums } = &*self.maps;
        let all = Rows::all(*size);
        let last = self.groups.len() - 1;
        for (a, [of_rows, of_columns]) in self.groups.iter().enumerate() {
            let to: Vec<&TextureView> = between.layers.iter().collect();
            match ends {
                Some(Ends { first: (rows, of_rows), .. }) if a == 0 => rows.record(encoder, &to, &[of_rows], all),
                _ => passes.rows.record(encoder, &to, &[of_rows], all),
            }
            let to: Vec<&TextureView> = maps.layers.iter().chain(&sums[a % 2].layers).collect();
            match ends {
                Some(Ends { last: (columns, of_columns), target, .. }) if a == last => {
                    columns.record(encoder, &[target], &[of_columns], all);
                }
                _ => passes.columns.record(encoder, &to, &[of_columns], all),
            }
        }
    }
}

/// Passes in place of the first along rows and the last along columns, with their bind groups and the last's target.
#[derive(Clone, Copy)]
pub(crate) struct Ends<'a> {
    pub(crate) first: (&'a FullscreenPass, &'a BindGroup),
    pub(crate) last: (&'a FullscreenPass, &'a BindGroup),
    pub(crate) target: &'a TextureView,
}
