//! Maps and bind groups of splats, and their passes, recorded.

use std::sync::Arc;

use glam::{Mat4, Vec3};
use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_scene::MeanProfile;
use subsurf_shaders::softening_gain;
use subsurf_shaders::uniform::{self, LightSource, MAX_RINGS, Splat, SplatRings, TsmLight, Upsampling};
use wgpu::{BindGroup, BindingResource, Buffer, Color, CommandEncoder, TextureView};

use super::levels::SplatLevels;
use super::passes::Passes;
use crate::asset::SplatMaterial;
use crate::error::Result;
use crate::frame::{Plan, RuntimeOptions};
use crate::gpu::{Gpu, HALF, Purpose, Rows, Surface2d, TextureSpec, Tracked, level_of};
use crate::technique::area::MapArea;
use crate::technique::bindings::{Bindings, Group, Lap, group_number};
use crate::technique::common::Common;
use crate::technique::mesh_pass::{Attachments, MeshPass, SharedGroups, cleared};
use crate::technique::tsm::{FAR_MM, TranslucentShadowMaps};

/// Number of rings that there is room for.
#[allow(clippy::cast_possible_truncation, reason = "five")]
const RINGS: u32 = MAX_RINGS as u32;

/// Maps for one size of picture, which materials use one after the other.
#[derive(Debug)]
pub(crate) struct Maps {
    size: [u32; 2],
    visible: [Surface2d; 3],
    depth: Surface2d,
    rings: Vec<Surface2d>,
    resolved: Surface2d,
}

/// Blocks and bind groups of one material.
#[derive(Debug)]
struct Bound {
    passes: Arc<Passes>,
    maps: Arc<Maps>,
    header: BssrdfHeader,
    mean: MeanProfile,
    /// Levels of the last frame.
    levels: SplatLevels,
    gbuffer: [BindGroup; 2],
    reductions: Vec<Reduction>,
    planes: BindGroup,
    draws: Vec<Draw>,
    resolve: BindGroup,
    rings_block: Tracked<Buffer>,
    upsampling: Tracked<Buffer>,
    shade: BindGroup,
}

/// Pass that makes one level of all lights' views from the level before.
#[derive(Debug)]
struct Reduction {
    level: u32,
    #[expect(dead_code, reason = "kept in the ledger as long as the device has it")]
    block: Tracked<Buffer>,
    group: BindGroup,
    targets: [TextureView; 3],
    size: [u32; 2],
}

/// Splats of the samples of one level of one tile, for one ring.
#[derive(Debug)]
struct Draw {
    tile: u32,
    ring: u32,
    refines: bool,
    block: Tracked<Buffer>,
    group: BindGroup,
    softening: Softening,
}

/// Factors of the first ring, for the distances in mm where it fades out.
#[derive(Clone, Copy, Debug, Default)]
struct Softening {
    fade_out: [f32; 2],
    gain: [[f32; 4]; 8],
}

impl Draw {
    fn level(&self, levels: &SplatLevels) -> u32 {
        levels.first + self.ring - u32::from(self.refines)
    }
}

impl Maps {
    /// Bytes on the device.
    pub(crate) fn bytes_of(plan: &Plan, options: &RuntimeOptions) -> u64 {
        let size = plan.map_size();
        let half = |size| TextureSpec::target("", size, HALF).bytes();
        let rings: u64 = (0..RINGS).map(|ring| half(SplatLevels::ring_size(size, ring))).sum();
        4 * half(size) + TextureSpec::attachment("", size, options.depth.format).bytes() + rings
    }

    pub(crate) fn new(gpu: &Gpu, plan: &Plan, options: &RuntimeOptions) -> Result<Self> {
        let size = plan.map_size();
        let target = |label, size| gpu.texture(&TextureSpec::target(label, size, HALF));
        let rings = (0..RINGS).map(|ring| target("ring", SplatLevels::ring_size(size, ring)));
        Ok(Self {
            size,
            visible: [target("positions", size)?, target("places", size)?, target("albedos", size)?],
            depth: gpu.texture(&TextureSpec::attachment("map depth", size, options.depth.format))?,
            rings: rings.collect::<Result<_>>()?,
            resolved: target("rings together", size)?,
        })
    }
}

impl Passes {
    /// Binds a material, number `slot` of a frame, to its maps.
    pub(crate) fn bind(
        self: &Arc<Self>,
        gpu: &Gpu,
        (material, slot): (&SplatMaterial, usize),
        common: &Common,
        lights: &TranslucentShadowMaps,
        maps: &Arc<Maps>,
        plan: &Plan,
    ) -> Result<Box<dyn Bindings>> {
        let texture = BindingResource::TextureView;
        let of_albedo = material.albedo.resources();
        let rings_block = gpu.uniform(Purpose::Frame, "rings", &SplatRings::default());
        let mut of_resolve =
            vec![rings_block.as_entire_binding(), texture(&maps.visible[0].view), texture(&maps.visible[2].view)];
        of_resolve.extend(maps.rings.iter().map(|ring| texture(&ring.view)));
        let upsampling = gpu.uniform(Purpose::Frame, "upsampling", &Upsampling::default());
        let of_shade =
            [of_albedo[0].clone(), of_albedo[1].clone(), upsampling.as_entire_binding(), texture(&maps.resolved.view)];
        Ok(Box::new(Bound {
            gbuffer: [
                self.gbuffer.bind(gpu, 0, &[common.scene.as_entire_binding()])?,
                self.gbuffer.bind(gpu, 1, &of_albedo)?,
            ],
            planes: self.splat.bind(gpu, 0, &material.planes.resources())?,
            resolve: self.resolve.bind(gpu, 0, &of_resolve)?,
            shade: self.shade.bind(gpu, 1, &of_shade)?,
            reductions: self.reductions(gpu, slot, lights, plan)?,
            draws: self.draws(gpu, lights, maps, plan)?,
            levels: SplatLevels { first: 1, rings: 1 },
            mean: material.mean.clone(),
            header: *material.planes.header(),
            rings_block,
            upsampling,
            maps: maps.clone(),
            passes: self.clone(),
        }))
    }

    /// Passes from every level of the lights' views to the next, of light that enters group number `slot`.
    fn reductions(
        &self,
        gpu: &Gpu,
        slot: usize,
        lights: &TranslucentShadowMaps,
        plan: &Plan,
    ) -> Result<Vec<Reduction>> {
        let reduction = |level| {
            let block = TsmLight { group: group_number(slot), level, ..Default::default() };
            let block = gpu.uniform(Purpose::Frame, "level of a shadow map", &block);
            let from = lights.surfaces().each_ref().map(|surface| level_of(surface, 0, level - 1));
            let mut resources = vec![block.as_entire_binding()];
            resources.extend(from.iter().map(BindingResource::TextureView));
            let group = self.tsm_reduce.bind(gpu, 0, &resources)?;
            let targets = lights.surfaces().each_ref().map(|surface| level_of(surface, 0, level));
            let size = plan.light_size().map(|side| (side >> level).max(1));
            Ok(Reduction { level, block, group, targets, size })
        };
        (1..plan.light_levels()).map(reduction).collect()
    }

    /// Splats of every tile and ring.
    fn draws(&self, gpu: &Gpu, lights: &TranslucentShadowMaps, maps: &Maps, plan: &Plan) -> Result<Vec<Draw>> {
        let texture = BindingResource::TextureView;
        let mut draws = Vec::new();
        for (tile, ring) in (0..plan.lights).flat_map(|tile| (0..RINGS).map(move |ring| (tile, ring))) {
            for refines in [false, true] {
                let block = gpu.uniform(Purpose::Frame, "splat", &Splat::default());
                let group = [
                    block.as_entire_binding(),
                    texture(lights.views()[0]),
                    texture(lights.views()[1]),
                    texture(lights.views()[2]),
                    texture(&maps.visible[0].view),
                    texture(&maps.visible[1].view),
                    texture(&maps.visible[2].view),
                ];
                let group = self.splat.bind(gpu, 1, &group)?;
                draws.push(Draw { tile, ring, refines, block, group, softening: Softening::default() });
            }
        }
        Ok(draws)
    }
}

/// Light of the tile of a draw, if it shines in the frame.
fn light_of<'a>(draw: &Draw, block: &'a uniform::Scene) -> Option<&'a LightSource> {
    block.drawn_shadows().nth(draw.tile as usize).map(|light| &block.light[light as usize])
}

impl Bindings for Bound {
    /// Tells the passes where lights and eye are.
    fn update(&mut self, gpu: &Gpu, group: &Group<'_>) {
        self.levels = SplatLevels::new(&self.header, group.radius_mm, group.plan.light_texels);
        let upsampling = group.upsampling(&MapArea::whole(group.plan.map_size()));
        gpu.queue.write_buffer(&self.upsampling, 0, bytemuck::bytes_of(&upsampling));
        let rings = SplatRings { count: self.levels.rings, near_mm: upsampling.near_mm, pad: [0; 2] };
        gpu.queue.write_buffer(&self.rings_block, 0, bytemuck::bytes_of(&rings));

        let block = group.block;
        let clip_from_world = Mat4::from_cols_array_2d(&block.clip_from_world);
        let clip_from_centre = clip_from_world * Mat4::from_translation(Vec3::from(block.centre_mm));
        let (levels, mean, header) = (self.levels, &self.mean, &self.header);
        for draw in self.draws.iter_mut().filter(|draw| draw.ring < levels.rings) {
            let Some(light) = light_of(draw, block) else { continue };
            #[allow(clippy::cast_precision_loss, reason = "small")]
            let texel_at = |level: u32| light.texel_mm * (1_u32 << level) as f32;
            // Distances are of samples of a directional light's first level.
            let in_mm = |edges: f32| edges * texel_at(levels.first);
            let [fade_in, fade_out] = levels.fades(draw.ring).map(|fade| fade.map(in_mm));
            let level = draw.level(&levels);
            if draw.ring == 0 && draw.softening.fade_out != fade_out {
                let gain = softening_gain(mean, header, fade_out).map(|[r, g, b]| [r, g, b, 0.0]);
                draw.softening = Softening { fade_out, gain };
            }
            let splat = Splat {
                softening_gain: draw.softening.gain,
                clip_from_centre: clip_from_centre.to_cols_array_2d(),
                fade_in,
                fade_out,
                middle_mm: light.middle_mm,
                texel_mm: texel_at(level),
                tile: draw.tile,
                level,
                side: (group.plan.light_texels >> level).max(1),
                refines: u32::from(draw.refines),
                stride: 1 << draw.ring,
                pitch_mm: header.pitch_mm,
                group: group.number(),
                columns: group.plan.light_columns,
                pad: [0; 2],
            };
            gpu.queue.write_buffer(&draw.block, 0, bytemuck::bytes_of(&splat));
        }
    }

    fn record(&self, encoder: &mut CommandEncoder, group: &Group<'_>, shared: SharedGroups<'_>, lap: Lap<'_>) {
        for reduction in self.reductions.iter().filter(|reduction| reduction.level < self.levels.count()) {
            let targets = reduction.targets.each_ref();
            self.passes.tsm_reduce.record(encoder, &targets, &[&reduction.group], Rows::all(reduction.size));
        }
        lap(self.passes.tsm_reduce.name(), encoder);
        let far = Color { r: 0.0, g: 0.0, b: 0.0, a: FAR_MM };
        let clears = [far, Color::TRANSPARENT, Color::TRANSPARENT];
        let attachments = Attachments {
            colours: &[0, 1, 2].map(|k| cleared(&self.maps.visible[k].view, clears[k])),
            depth: &self.maps.depth.view,
            depth_ops: self.passes.depth.own(),
            viewport: None,
        };
        let [scene, albedo] = &self.gbuffer;
        self.passes.gbuffer.record(encoder, &attachments, [scene, albedo], shared, group.draws());
        lap(self.passes.gbuffer.name(), encoder);
        for (ring, number) in self.maps.rings.iter().zip(0..self.levels.rings) {
            let draws = self.draws.iter().filter(|draw| draw.ring == number && light_of(draw, group.block).is_some());
            let squares = |draw: &Draw| (group.plan.light_texels >> draw.level(&self.levels)).max(1).pow(2);
            let draws: Vec<_> = draws.map(|draw| (&draw.group, squares(draw))).collect();
            self.passes.splat.record(encoder, &ring.view, &self.planes, &draws);
        }
        lap(self.passes.splat.name(), encoder);
        let resolved = [&self.maps.resolved.view];
        self.passes.resolve.record(encoder, &resolved, &[&self.resolve], Rows::all(self.maps.size));
        lap(self.passes.resolve.name(), encoder);
    }

    fn shade(&self) -> (&MeshPass, &BindGroup) {
        (&self.passes.shade, &self.shade)
    }
}
