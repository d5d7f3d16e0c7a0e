//! Blocks and bind groups of the light volume of a material, and its passes, recorded.

use std::sync::Arc;

use glam::Mat4;
use subsurf_shaders::uniform::{self, BlurStage, LightSource, OWN_SHADOW};
use wgpu::{BindGroup, BindingResource, Buffer, CommandEncoder};

use super::TEXELS;
use super::grid::Grid;
use super::passes::Passes;
use crate::asset::SeparableMaterial;
use crate::error::Result;
use crate::gpu::{FullscreenPass, Gpu, Purpose, Rows, Tracked};
use crate::technique::bindings::{Group, Lap};
use crate::technique::cascade::CascadeMaps;
use crate::technique::common::Common;
use crate::technique::tsm::TranslucentShadowMaps;

/// Light volume of one material.
#[derive(Debug)]
pub(crate) struct Volume {
    maps: Arc<CascadeMaps>,
    block: Tracked<Buffer>,
    /// Bind groups of the pass that fills it.
    fill: [BindGroup; 2],
    stages: Vec<Stage>,
    sigmas_mm: Vec<f32>,
    /// Cells of the last frame, if there were any.
    grid: Option<Grid>,
}

/// Stage of the cascade for one Gaussian.
#[derive(Debug)]
struct Stage {
    flat: BlurStage,
    /// Blocks along x, y and z.
    blocks: [Tracked<Buffer>; 3],
    axes: [BindGroup; 3],
    sum: BindGroup,
    /// Numbers of the maps that have the light so far, what is between two axes, and the sums before.
    turns: [usize; 3],
}

impl Volume {
    /// Binds a material to the maps of the blurs on the screen, which are free until those begin.
    pub(crate) fn new(
        gpu: &Gpu,
        passes: &Passes,
        material: &SeparableMaterial,
        common: &Common,
        lights: &TranslucentShadowMaps,
        maps: &Arc<CascadeMaps>,
    ) -> Result<Self> {
        let block = gpu.uniform(Purpose::Frame, "light volume", &uniform::Volume::default());
        let seen = lights.views().map(BindingResource::TextureView);
        let [layers, sampler] = material.layers.resources();
        let of_light = [common.scene.as_entire_binding(), seen[0].clone()];
        let of_volume = [layers, sampler, block.as_entire_binding(), seen[1].clone(), seen[2].clone()];
        let count = material.gaussians();
        let stage = |(a, flat): (usize, &BlurStage)| {
            let blocks = [(); 3].map(|()| gpu.uniform(Purpose::Frame, "stage in a light volume", flat));
            // The sums of the last stage are in the first maps.
            let turns = [0, 1, 2].map(|k| (k + 2 * (count - 1 - a)) % 3);
            let map = |number: usize| maps.in_turns()[turns[number]].all();
            let of_axis = |axis: usize| {
                let of = [blocks[axis].as_entire_binding(), block.as_entire_binding(), map(axis % 2)];
                passes.blur.bind(gpu, 0, &of)
            };
            let of_sum = [blocks[0].as_entire_binding(), block.as_entire_binding(), map(1), map(2)];
            let sum = passes.sum.bind(gpu, 0, &of_sum)?;
            Ok(Stage { flat: *flat, axes: [of_axis(0)?, of_axis(1)?, of_axis(2)?], sum, blocks, turns })
        };
        Ok(Self {
            maps: maps.clone(),
            fill: [passes.fill.bind(gpu, 0, &of_light)?, passes.fill.bind(gpu, 1, &of_volume)?],
            stages: material.stages().iter().enumerate().map(stage).collect::<Result<_>>()?,
            sigmas_mm: material.sigmas_mm().collect(),
            grid: None,
            block,
        })
    }

    /// What passes read of it: the block, and the sums.
    pub(crate) fn resources(&self) -> [BindingResource<'_>; 2] {
        [self.block.as_entire_binding(), self.maps.in_turns()[0].all()]
    }

    /// Number of Gaussians that do not spread in the volume, in the last frame.
    pub(crate) fn first(&self) -> usize {
        self.grid.map_or(self.sigmas_mm.len(), |grid| grid.first)
    }

    /// Lays cells over the objects of a group and tells the passes where they are. All lights that shine have to have views of their own:
    /// of others nothing would spread.
    pub(crate) fn update(&mut self, gpu: &Gpu, group: &Group<'_>, pitch_mm: f32) {
        let scene = group.block;
        let lights = &scene.light[..scene.lights as usize];
        let has_light = |light: &&LightSource| light.irradiance != [0.0; 3];
        let are_drawn = lights.iter().filter(has_light).all(|light| light.shadow == OWN_SHADOW);
        let grid = Grid::new(group.extent(), &self.sigmas_mm, TEXELS);
        // Where lights see less than a sample in a cell, dots would be seen.
        let is_fine = |grid: &Grid| lights.iter().all(|light| light.texel_mm <= grid.cell_mm);
        self.grid = grid.filter(|grid| are_drawn && !lights.is_empty() && is_fine(grid));
        let none = Grid::default();
        let grid = self.grid.as_ref().unwrap_or(&none);
        let mut block = uniform::Volume {
            origin_mm: grid.origin_mm.into(),
            cell_mm: grid.cell_mm,
            cells: grid.cells.into(),
            columns: grid.columns,
            first: u32::try_from(self.first()).unwrap_or(u32::MAX),
            group: group.number(),
            pitch_mm,
            ..Default::default()
        };
        for (to, light) in block.world_from_clip.iter_mut().zip(lights) {
            *to = Mat4::from_cols_array_2d(&light.clip_from_world).inverse().to_cols_array_2d();
        }
        gpu.queue.write_buffer(&self.block, 0, bytemuck::bytes_of(&block));
        if let Some(grid) = &self.grid {
            self.update_stages(gpu, grid);
        }
    }

    /// Tells the stages how wide they are in cells.
    fn update_stages(&self, gpu: &Gpu, grid: &Grid) {
        let mut before = None;
        for (stage, sigma_mm) in self.stages.iter().zip(&self.sigmas_mm).skip(grid.first) {
            let cells = sigma_mm / grid.cell_mm;
            let sigma = before.map_or(grid.first_sigma(*sigma_mm), |narrower: f32| {
                (cells * cells - narrower * narrower).max(1e-4).sqrt()
            });
            // Three axes make exp(-r^2 / 2 sigma^2) / (2 pi)^(3/2) sigma^3 of light in a cell, 1/(2 pi sigma^2) is wanted.
            let gain = std::f32::consts::TAU.sqrt() * cells;
            let blocks = stage.flat.in_volume(gain, sigma, before.is_some());
            for (to, block) in stage.blocks.iter().zip(&blocks) {
                gpu.queue.write_buffer(to, 0, bytemuck::bytes_of(block));
            }
            before = Some(cells);
        }
    }

    /// Records all passes of the volume.
    pub(crate) fn record(&self, encoder: &mut CommandEncoder, passes: &Passes, lap: Lap<'_>) {
        let Some(grid) = &self.grid else {
            return;
        };
        let stages = &self.stages[grid.first..];
        let mut draw = |pass: &FullscreenPass, groups: &[&BindGroup], turn: usize| {
            let targets: Vec<_> = self.maps.in_turns()[turn].layers.iter().collect();
            pass.record(encoder, &targets, groups, Rows::all(grid.texels()));
            lap(pass.name(), encoder);
        };
        draw(&passes.fill, &self.fill.each_ref(), stages[0].turns[0]);
        for Stage { axes, sum, turns, .. } in stages {
            for (axis, group) in axes.iter().enumerate() {
                draw(&passes.blur, &[group], turns[(axis + 1) % 2]);
            }
            draw(&passes.sum, &[sum], turns[0]);
        }
    }
}
