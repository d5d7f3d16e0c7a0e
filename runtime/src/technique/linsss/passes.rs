//! Pipelines of LinSSS, and what one material binds to them.

use std::sync::Arc;

use subsurf_shaders::passes::linsss;
use subsurf_shaders::uniform::{Linsss, LinsssStage, Upsampling};
use wgpu::{BindingResource, Color, TextureView};

use super::bound::{Bound, Turn};
use super::maps::{Maps, Means};
use crate::asset::LinsssMaterial;
use crate::error::Result;
use crate::frame::RuntimeOptions;
use crate::gpu::{FullscreenPass, Gpu, Purpose};
use crate::technique::area::MapArea;
use crate::technique::bindings::Bindings;
use crate::technique::common::Common;
use crate::technique::mesh_pass::{DepthFormat, MeshPass};
use crate::technique::tsm::{FAR_MM, TranslucentShadowMaps};

/// Pipelines, for any number of Gaussians.
#[derive(Debug)]
pub(crate) struct Passes {
    pub(super) depth: DepthFormat,
    pub(super) gbuffer: MeshPass,
    pub(super) blur: FullscreenPass,
    pub(super) reduce: FullscreenPass,
    pub(super) lookup: FullscreenPass,
    pub(super) shade: MeshPass,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, options: &RuntimeOptions) -> Result<Self> {
        let map = gpu.target_texture_format();
        Ok(Self {
            depth: options.depth,
            gbuffer: MeshPass::lit(gpu, linsss::LINSSS_GBUFFER.only(), &[map; 3], options)?,
            blur: FullscreenPass::new(gpu, linsss::LINSSS_BLUR.only(), &[map; 2])?,
            reduce: FullscreenPass::new(gpu, linsss::LINSSS_REDUCE.only(), &[map])?,
            lookup: FullscreenPass::new(gpu, linsss::LINSSS_LOOKUP.only(), &[map])?,
            shade: MeshPass::picture(gpu, linsss::SHADE_LINSSS.only(), options)?,
        })
    }

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
                let bind = |[light, weighted]: [&crate::gpu::Surface2d; 2]| {
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

fn texture(view: &TextureView) -> BindingResource<'_> {
    BindingResource::TextureView(view)
}
