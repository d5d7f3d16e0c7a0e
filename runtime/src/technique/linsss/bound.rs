//! Passes of LinSSS of one material in a frame.

use std::sync::Arc;

use subsurf_shaders::uniform::{Linsss, LinsssStage, Upsampling};
use wgpu::{BindGroup, BindingResource, Buffer, Color, CommandEncoder, TextureView};

use super::maps::{Maps, Means};
use super::passes::Passes;
use crate::asset::LinsssMaterial;
use crate::error::Result;
use crate::gpu::{Gpu, Purpose, Rows, Surface2d, Tracked};
use crate::technique::area::MapArea;
use crate::technique::bindings::{Bindings, Group, Lap};
use crate::technique::common::Common;
use crate::technique::mesh_pass::{Attachments, MeshPass, SharedGroups, cleared};
use crate::technique::tsm::{FAR_MM, TranslucentShadowMaps};

/// Block and bind group of one pass over the maps.
#[derive(Debug)]
pub(super) struct Turn {
    pub(super) block: Tracked<Buffer>,
    pub(super) group: BindGroup,
}

/// Blocks and bind groups of one material.
#[derive(Debug)]
pub(super) struct Bound {
    pub(super) passes: Arc<Passes>,
    pub(super) material: Arc<LinsssMaterial>,
    pub(super) maps: Maps,
    pub(super) scene: BindGroup,
    /// One for every Gaussian whose weighted light is drawn.
    pub(super) gbuffers: Vec<BindGroup>,
    /// Passes of every Gaussian.
    pub(super) gaussians: Vec<Vec<Turn>>,
    /// Passes to the levels of the pyramid but the finest.
    pub(super) reductions: Vec<Turn>,
    pub(super) upsampling: Tracked<Buffer>,
    pub(super) shade: BindGroup,
    pub(super) area: MapArea,
    /// What maps hold where nothing is seen.
    pub(super) far: Color,
}

impl Passes {
    /// Binds a material to the maps of a frame.
    pub(crate) fn bind(
        self: &Arc<Self>,
        gpu: &Gpu,
        material: &Arc<LinsssMaterial>,
        common: &Common,
        lights: &TranslucentShadowMaps,
        maps: Maps,
    ) -> Result<Box<dyn Bindings>> {
        let count = material.gaussians();
        let turns = if material.is_shortcut() { 1 } else { count };
        let stage = || gpu.uniform(Purpose::Frame, "stage of LinSSS", &LinsssStage::default());
        let upsampling = gpu.uniform(Purpose::Frame, "upsampling", &Upsampling::default());
        let patch = material.layers.resources();
        let block = |turn: usize| {
            let turn = u32::try_from(turn).unwrap_or(0);
            gpu.uniform(Purpose::Frame, "Gaussians of LinSSS", &Linsss { turn, ..material.block })
        };
        let of_scene = [common.scene.as_entire_binding(), texture(lights.views()[0])];
        let gbuffers = (0..turns).map(|turn| {
            let block = block(turn);
            let of_gbuffer = [
                patch[0].clone(),
                patch[1].clone(),
                block.as_entire_binding(),
                texture(lights.views()[1]),
                texture(lights.views()[2]),
            ];
            self.gbuffer.bind(gpu, 1, &of_gbuffer)
        });
        let gbuffers = gbuffers.collect::<Result<Vec<_>>>()?;
        // One look-up for every Gaussian, or two blurs: along rows and along columns.
        let gaussians = (0..count).map(|_| match &maps.by {
            Means::Pyramid([slight, pyramid]) => {
                let block = stage();
                let of_lookup = [
                    block.as_entire_binding(),
                    texture(&maps.light.view),
                    texture(&slight.view),
                    texture(&pyramid.view),
                ];
                let group = self.lookup.bind(gpu, 0, &of_lookup)?;
                Ok(vec![Turn { block, group }])
            }
            Means::Blurs([light, weighted]) => {
                let sources = [[&maps.light, &maps.weighted], [light, weighted]];
                let bind = |[light, weighted]: [&Surface2d; 2]| {
                    let block = stage();
                    let of_blur = [block.as_entire_binding(), texture(&light.view), texture(&weighted.view)];
                    let group = self.blur.bind(gpu, 0, &of_blur)?;
                    Ok(Turn { block, group })
                };
                sources.into_iter().map(bind).collect()
            }
        });
        let gaussians = gaussians.collect::<Result<Vec<_>>>()?;
        let reductions = maps.levels.windows(2).map(|pair| {
            let block = stage();
            let group = self.reduce.bind(gpu, 0, &[block.as_entire_binding(), texture(&pair[0])])?;
            Ok(Turn { block, group })
        });
        let reductions = reductions.collect::<Result<Vec<_>>>()?;
        let block = block(0);
        let of_shade = [
            patch[0].clone(),
            patch[1].clone(),
            upsampling.as_entire_binding(),
            block.as_entire_binding(),
            texture(&maps.blurred[0].view),
            texture(&maps.blurred[1].view),
            texture(&maps.through.view),
        ];
        Ok(Box::new(Bound {
            scene: self.gbuffer.bind(gpu, 0, &of_scene)?,
            shade: self.shade.bind(gpu, 1, &of_shade)?,
            far: gpu.clear_colour(Color { r: 0.0, g: 0.0, b: 0.0, a: FAR_MM }),
            area: MapArea::default(),
            material: material.clone(),
            passes: self.clone(),
            gbuffers,
            gaussians,
            reductions,
            upsampling,
            maps,
        }))
    }
}

impl Bindings for Bound {
    /// Tells the passes how large things are on the screen.
    fn update(&mut self, gpu: &Gpu, group: &Group<'_>) {
        let (view, plan) = (&group.input.view, group.plan);
        self.area = MapArea::over(view, &group.bounds, plan.size, plan.blur_size, plan.divisor);
        let of_screen = LinsssStage {
            size: self.area.size.map(|side| i32::try_from(side).unwrap_or(i32::MAX)),
            focal_texels: self.area.texels_per_tangent(view),
            middle_mm: group.middle_mm(),
            perspective: if view.is_parallel() { 0.0 } else { 1.0 },
            most: self.maps.size().map(|side| i32::try_from(side).unwrap_or(i32::MAX)),
            levels: u32::try_from(self.maps.levels.len()).unwrap_or(1),
            ..LinsssStage::default()
        };
        let write =
            |turn: &Turn, stage: LinsssStage| gpu.queue.write_buffer(&turn.block, 0, bytemuck::bytes_of(&stage));
        for (turns, sigma_mm) in self.gaussians.iter().zip(self.material.block.sigmas_mm) {
            for (turn, axis) in turns.iter().zip([[1, 0], [0, 1]]) {
                write(turn, LinsssStage { sigma_mm, axis, ..of_screen });
            }
        }
        for (turn, level) in self.reductions.iter().zip(1..) {
            write(turn, LinsssStage { level, ..of_screen });
        }
        gpu.queue.write_buffer(&self.upsampling, 0, bytemuck::bytes_of(&group.upsampling(&self.area)));
    }

    fn record(&self, encoder: &mut CommandEncoder, group: &Group<'_>, shared: SharedGroups<'_>, lap: Lap<'_>) {
        let (passes, maps) = (&*self.passes, &self.maps);
        let size = self.area.size;
        let colours = [&maps.levels[0], &maps.weighted.view, &maps.through.view].map(|view| cleared(view, self.far));
        let attachments = Attachments {
            colours: &colours,
            depth: &maps.depth.view,
            depth_ops: passes.depth.own(),
            viewport: Some(self.area.viewport()),
        };
        // The first Gaussian comes last: with it, what comes through from behind.
        for (h, gbuffer) in self.gbuffers.iter().enumerate().rev() {
            passes.gbuffer.record(encoder, &attachments, [&self.scene, gbuffer], shared, group.draws());
            lap(passes.gbuffer.name(), encoder);
            if let (Means::Blurs([light, weighted]), [rows, columns]) = (&maps.by, &self.gaussians[h][..]) {
                let layers = [&maps.layers[0][h], &maps.layers[1][h]];
                for (turn, targets) in [(rows, [&light.view, &weighted.view]), (columns, layers)] {
                    passes.blur.record(encoder, &targets, &[&turn.group], Rows::all(size));
                    lap(passes.blur.name(), encoder);
                }
            }
        }
        if matches!(maps.by, Means::Blurs(_)) {
            return;
        }
        let most = maps.size();
        for ((turn, level), k) in self.reductions.iter().zip(&maps.levels[1..]).zip(1_u32..) {
            // Levels 0, 1 and 2 are of the same size. Half texels at the end have none of their own where the map ends.
            let halvings = k.max(2) - 2;
            let texels = [0, 1].map(|axis| size[axis].div_ceil(1 << halvings).min((most[axis] >> halvings).max(1)));
            passes.reduce.record(encoder, &[level], &[&turn.group], Rows::all(texels));
            lap(passes.reduce.name(), encoder);
        }
        for (turns, layer) in self.gaussians.iter().zip(&maps.layers[0]) {
            passes.lookup.record(encoder, &[layer], &[&turns[0].group], Rows::all(size));
            lap(passes.lookup.name(), encoder);
        }
    }

    fn shade(&self) -> (&MeshPass, &BindGroup) {
        (&self.passes.shade, &self.shade)
    }
}

fn texture(view: &TextureView) -> BindingResource<'_> {
    BindingResource::TextureView(view)
}
