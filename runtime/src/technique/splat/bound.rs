//! Maps and bind groups of splats for one size of picture, and their passes, recorded.

use std::sync::Arc;

use glam::{Mat4, Vec3};
use subsurf_scene::{Placement, Scene};
use subsurf_shaders::uniform::{self, MAX_RINGS, Splat, SplatRings, TsmLight, Upsampling};
use wgpu::{BindGroup, BindingResource, Buffer, Color, CommandEncoder, TextureView};

use super::levels::{FADE, Levels, RING, divisor, ring_size};
use super::passes::Passes;
use crate::asset::{GpuMesh, SplatMaterial};
use crate::error::Result;
use crate::frame::plan::Plan;
use crate::gpu::{DEPTH, Gpu, HALF, Rows, Surface2d, TextureSpec, Tracked, layers_of_level, level_of};
use crate::technique::common::{Common, Lap};
use crate::technique::drawable::Drawable;
use crate::technique::mesh_pass::{MeshPass, Target};
use crate::technique::pipelines::{Bindings, Pipelines, wrong_drawable};
use crate::technique::tsm::{FAR, TranslucentShadowMaps};

/// Maps, blocks and bind groups for one size of picture.
#[derive(Debug)]
struct Bound {
    passes: Arc<Passes>,
    levels: Levels,
    visible: [Surface2d; 3],
    depth: Surface2d,
    rings: Vec<Surface2d>,
    resolved: Surface2d,
    gbuffer: [BindGroup; 2],
    reductions: Vec<Reduction>,
    material: BindGroup,
    draws: Vec<Draw>,
    resolve: BindGroup,
    rings_block: Tracked<Buffer>,
    upsampling: Tracked<Buffer>,
    /// Blocks of the reductions.
    #[expect(dead_code, reason = "kept in the ledger as long as the device has them")]
    numbers: Vec<Tracked<Buffer>>,
    shade: BindGroup,
    softening_gain: [[f32; 4]; 8],
    pitch_mm: f32,
    size: [u32; 2],
}

/// Pass that makes one level of one light's view from the level before.
#[derive(Debug)]
struct Reduction {
    light: u32,
    group: BindGroup,
    targets: [TextureView; 3],
    size: [u32; 2],
}

/// Splats of the samples of one level of one light, for one ring.
#[derive(Debug)]
struct Draw {
    light: u32,
    ring: u32,
    level: u32,
    refines: bool,
    block: Tracked<Buffer>,
    group: BindGroup,
}

impl Bound {
    fn new(
        gpu: &Gpu,
        passes: Arc<Passes>,
        material: &SplatMaterial,
        common: &Common,
        lights: &TranslucentShadowMaps,
        plan: &Plan,
        placement: &Placement,
    ) -> Result<Self> {
        material.planes.expect(passes.layout)?;
        let levels = Levels::new(placement, plan.light_texels);
        let size = plan.map_size();
        let target = |label, size| gpu.texture(&TextureSpec::target(label, size, HALF));
        let visible = [target("positions", size)?, target("places", size)?, target("albedos", size)?];
        let rings = (0..levels.rings).map(|ring| target("ring", ring_size(size, ring)));
        let rings: Vec<Surface2d> = rings.collect::<Result<_>>()?;
        let resolved = target("rings together", size)?;
        let texture = BindingResource::TextureView;
        let of_albedo = [texture(&material.albedo.all), BindingResource::Sampler(&material.albedo.sampler)];

        let numbers: Vec<Tracked<Buffer>> = (0..plan.lights)
            .map(|light| gpu.uniform("light of a shadow map", &TsmLight { light, pad: [0; 3] }))
            .collect();
        let mut reductions = Vec::new();
        for (block, light) in numbers.iter().zip(0..) {
            for level in 1..levels.count() {
                let from = lights.surfaces().each_ref().map(|surface| layers_of_level(surface, level - 1));
                let mut group = vec![block.as_entire_binding()];
                group.extend(from.iter().map(BindingResource::TextureView));
                reductions.push(Reduction {
                    light,
                    group: passes.tsm_reduce.bind(gpu, 0, &group)?,
                    targets: lights.surfaces().each_ref().map(|surface| level_of(surface, light, level)),
                    size: [(plan.light_texels >> level).max(1); 2],
                });
            }
        }

        let mut draws = Vec::new();
        for (light, ring) in (0..plan.lights).flat_map(|light| (0..levels.rings).map(move |ring| (light, ring))) {
            for refines in [false, true] {
                let block = gpu.uniform("splat", &Splat::default());
                let group = [
                    block.as_entire_binding(),
                    texture(&lights.all[0]),
                    texture(&lights.all[1]),
                    texture(&lights.all[2]),
                    texture(&visible[0].view),
                    texture(&visible[1].view),
                ];
                let group = passes.splat.bind(gpu, 1, &group)?;
                let level = levels.first + ring - u32::from(refines);
                draws.push(Draw { light, ring, level, refines, block, group });
            }
        }

        let rings_block = gpu.uniform("rings", &SplatRings::default());
        let mut of_resolve =
            vec![rings_block.as_entire_binding(), texture(&visible[0].view), texture(&visible[2].view)];
        // SplatRings that do not exist are never read.
        of_resolve.extend((0..MAX_RINGS).map(|ring| texture(&rings[ring.min(rings.len() - 1)].view)));
        let upsampling = gpu.uniform("upsampling", &Upsampling::default());
        let of_shade =
            [of_albedo[0].clone(), of_albedo[1].clone(), upsampling.as_entire_binding(), texture(&resolved.view)];
        Ok(Self {
            gbuffer: [
                passes.gbuffer.bind(gpu, 0, &[common.block.as_entire_binding()])?,
                passes.gbuffer.bind(gpu, 1, &of_albedo)?,
            ],
            material: passes.splat.bind(gpu, 0, &material.planes.resources())?,
            resolve: passes.resolve.bind(gpu, 0, &of_resolve)?,
            shade: passes.shade.bind(gpu, 1, &of_shade)?,
            depth: gpu.texture(&TextureSpec::attachment("map depth", size, DEPTH))?,
            levels,
            visible,
            rings,
            resolved,
            reductions,
            draws,
            rings_block,
            upsampling,
            numbers,
            softening_gain: material.softening_gain.map(|[r, g, b]| [r, g, b, 0.0]),
            pitch_mm: placement.pitch_mm,
            size,
            passes,
        })
    }
}

impl Pipelines for Passes {
    fn bytes(&self, plan: &Plan, placement: &Placement) -> u64 {
        let levels = Levels::new(placement, plan.light_texels);
        let size = plan.map_size();
        let half = |size| TextureSpec::target("", size, HALF).bytes();
        let rings: u64 = (0..levels.rings).map(|ring| half(ring_size(size, ring))).sum();
        4 * half(size) + TextureSpec::target("", size, DEPTH).bytes() + rings + plan.light_bytes(levels.count())
    }

    fn light_levels(&self, plan: &Plan, placement: &Placement) -> u32 {
        Levels::new(placement, plan.light_texels).count()
    }

    fn divisor(&self, drawable: &Drawable<'_>, light_texels: u32, pixels_per_mm: f32) -> u32 {
        divisor(&drawable.mesh().placement, light_texels, pixels_per_mm)
    }

    fn shade(&self) -> &MeshPass {
        &self.shade
    }

    fn bind(
        self: Arc<Self>,
        gpu: &Gpu,
        drawable: &Drawable<'_>,
        common: &Common,
        lights: &TranslucentShadowMaps,
        plan: &Plan,
    ) -> Result<Box<dyn Bindings>> {
        let Drawable::Splat { mesh, material } = drawable else {
            return Err(wrong_drawable());
        };
        Ok(Box::new(Bound::new(gpu, self, material, common, lights, plan, &mesh.placement)?))
    }
}

impl Bindings for Bound {
    /// Tells the passes where lights and eye are.
    fn update(
        &mut self,
        gpu: &Gpu,
        drawable: &Drawable<'_>,
        scene: &Scene,
        block: &uniform::Scene,
        plan: &Plan,
    ) -> Result<()> {
        let Drawable::Splat { .. } = drawable else {
            return Err(wrong_drawable());
        };
        let upsampling = plan.upsampling(&scene.camera, block.middle_mm);
        gpu.queue.write_buffer(&self.upsampling, 0, bytemuck::bytes_of(&upsampling));
        let rings = SplatRings { count: self.levels.rings, near_mm: upsampling.near_mm, pad: [0; 2] };
        gpu.queue.write_buffer(&self.rings_block, 0, bytemuck::bytes_of(&rings));

        #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
        let [width, height] = plan.size.map(|side| side as f32);
        let cotangent = 1.0 / (0.5 * scene.camera.fov_y_rad).tan();
        let clip_from_world = Mat4::from_cols_array_2d(&block.clip_from_world);
        let clip_from_centre = clip_from_world * Mat4::from_translation(Vec3::from(block.centre_mm));
        for draw in &self.draws {
            let light = &block.light[draw.light as usize];
            #[allow(clippy::cast_precision_loss, reason = "small")]
            let texel_at = |level: u32| light.texel_mm * (1_u32 << level) as f32;
            // The ring ends where the next begins; distances are of samples of a directional light's first level.
            let end = |ring: u32| RING * texel_at(self.levels.first + ring);
            let fade = |ring: u32| [end(ring), FADE * end(ring)];
            let beyond = [1e6, 2e6];
            let splat = Splat {
                softening_gain: self.softening_gain,
                clip_from_centre: clip_from_centre.to_cols_array_2d(),
                fade_in: if draw.ring == 0 { [0.0; 2] } else { fade(draw.ring - 1) },
                fade_out: if draw.ring + 1 == self.levels.rings { beyond } else { fade(draw.ring) },
                focal: [cotangent * height / width, cotangent],
                middle_mm: light.middle_mm,
                texel_mm: texel_at(draw.level),
                light: draw.light,
                level: draw.level,
                side: (plan.light_texels >> draw.level).max(1),
                refines: u32::from(draw.refines),
                stride: 1 << draw.ring,
                pitch_mm: self.pitch_mm,
                pad: [0; 2],
            };
            gpu.queue.write_buffer(&draw.block, 0, bytemuck::bytes_of(&splat));
        }
        Ok(())
    }

    fn record(
        &self,
        mut encoder: CommandEncoder,
        mesh: &GpuMesh,
        lights: usize,
        plan: &Plan,
        lap: Lap<'_>,
    ) -> CommandEncoder {
        let lit = |light: u32| (light as usize) < lights;
        for reduction in self.reductions.iter().filter(|reduction| lit(reduction.light)) {
            let targets = reduction.targets.each_ref();
            self.passes.tsm_reduce.record(&mut encoder, &targets, &[&reduction.group], Rows::all(reduction.size));
        }
        encoder = lap("tsm mipmaps", encoder);
        let clears = [FAR, Color::TRANSPARENT, Color::TRANSPARENT];
        let targets = [0, 1, 2].map(|k| Target { view: &self.visible[k].view, clear: clears[k], resolved: None });
        let [scene, albedo] = &self.gbuffer;
        self.passes.gbuffer.record(&mut encoder, &targets, &self.depth.view, &[scene, albedo], mesh);
        encoder = lap("gbuffer", encoder);
        for (ring, number) in self.rings.iter().zip(0..) {
            let draws = self.draws.iter().filter(|draw| draw.ring == number && lit(draw.light));
            let squares = |draw: &Draw| (plan.light_texels >> draw.level).max(1).pow(2);
            let draws: Vec<_> = draws.map(|draw| (&draw.group, squares(draw))).collect();
            self.passes.splat.record(&mut encoder, &ring.view, &self.material, &draws);
        }
        encoder = lap("splat", encoder);
        self.passes.resolve.record(&mut encoder, &[&self.resolved.view], &[&self.resolve], Rows::all(self.size));
        lap("resolve", encoder)
    }

    fn shade(&self) -> &BindGroup {
        &self.shade
    }
}
