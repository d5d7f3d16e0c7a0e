//! Multiresolution splatting: light of samples that lights see, spread in space, ring by ring.
//!
//! The reach of scattering is cut into rings, each twice as wide as the one before. A wider ring takes its samples from a
//! coarser level of what the light sees, and adds them to a target of half the size: every ring costs about as many
//! fragments for each sample, and a quarter of the samples.

use glam::{Mat4, Vec3};
use subsurf_shaders::Storage;
use subsurf_shaders::source;
use subsurf_shaders::uniform::{self, MAX_RINGS, Rings, Splat, Upsampling, Which};
use wgpu::{BindGroup, BindingResource, Buffer, Color, CommandEncoder, TextureFormat, TextureView};

use super::light_views::{FAR, LightViews};
use super::plan::Plan;
use super::{COMMON, Common, Lap, encoding_of};
use crate::context::Gpu;
use crate::error::Result;
use crate::factors::SplatMaterial;
use crate::ledger::Tracked;
use crate::material::{layers_of_level, slots};
use crate::mesh::{DEPTH, GpuMesh, MeshPass, Target};
use crate::pass::{CoverPass, Rows, SquarePass};
use crate::resource::{Slot, Surface2d, TextureSpec, level_of};
use subsurf_scene::{Outline, Scene};

const HALF: TextureFormat = TextureFormat::Rgba16Float;
/// Edge of samples of the first ring, in pixels of the material.
const SAMPLE_PIXELS: f32 = 1.0;
/// Where the first ring begins to fade out, in edges of its samples, and where it ends.
const RING: f32 = 2.0;
const FADE: f32 = 1.6;
/// Texels of the finest target to an edge of a sample of the first ring.
const TEXELS_PER_SAMPLE: f32 = 2.0;

/// Its pipelines.
#[derive(Debug)]
pub(crate) struct Passes {
    storage: Storage,
    view: MeshPass,
    reduce: CoverPass,
    splat: SquarePass,
    collapse: CoverPass,
    pub(crate) shade: MeshPass,
}

/// How samples and rings go with a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Levels {
    /// Level of what lights see that the first ring takes its samples from.
    first: u32,
    /// Number of rings.
    rings: u32,
}

impl Levels {
    /// For views of `light_texels` to a side that see a mesh of a certain size.
    pub(crate) fn new(outline: &Outline, light_texels: u32) -> Self {
        #[allow(clippy::cast_precision_loss, reason = "a thousand")]
        let texel_mm = 2.0 * outline.radius_mm / light_texels as f32;
        let sample_mm = SAMPLE_PIXELS * outline.header.pitch_mm;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let first = (sample_mm / texel_mm).log2().round().clamp(1.0, 5.0) as u32;
        #[allow(clippy::cast_precision_loss, reason = "small")]
        let first_mm = texel_mm * (1_u32 << first) as f32;
        let reach = outline.header.r_max_mm / (RING * first_mm);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let rings = (reach.log2().ceil() + 1.0).clamp(1.0, MAX_RINGS as f32) as u32;
        Self { first, rings: rings.min(light_texels.ilog2().saturating_sub(first).max(1)) }
    }

    /// Levels that lights' views have.
    pub(crate) fn count(&self) -> u32 {
        self.first + self.rings
    }
}

/// Pixels of the picture to a side of a texel of the finest target.
pub(crate) fn divisor(outline: &Outline, light_texels: u32, pixels_per_mm: f32) -> u32 {
    let levels = Levels::new(outline, light_texels);
    #[allow(clippy::cast_precision_loss, reason = "small")]
    let sample_mm = 2.0 * outline.radius_mm / light_texels as f32 * (1_u32 << levels.first) as f32;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let divisor = (sample_mm * pixels_per_mm / TEXELS_PER_SAMPLE).clamp(1.0, 8.0) as u32;
    // Of what is no number nothing is left.
    divisor.max(1)
}

/// Its buffers, for one size of picture.
#[derive(Debug)]
pub(crate) struct Buffers {
    levels: Levels,
    visible: [Surface2d; 3],
    depth: Surface2d,
    rings: Vec<Surface2d>,
    collapsed: Surface2d,
    view: [BindGroup; 2],
    reductions: Vec<Reduction>,
    material: BindGroup,
    draws: Vec<Draw>,
    collapse: BindGroup,
    rings_block: Tracked<Buffer>,
    upsampling: Tracked<Buffer>,
    /// Bound to the reductions.
    #[expect(dead_code, reason = "kept in the ledger as long as the device has them")]
    which: Vec<Tracked<Buffer>>,
    pub(crate) shade: BindGroup,
    softened: [[f32; 4]; 8],
    pitch_mm: f32,
    size: [u32; 2],
}

/// One level of one light from the level before.
#[derive(Debug)]
struct Reduction {
    light: u32,
    group: BindGroup,
    targets: [TextureView; 3],
    size: [u32; 2],
}

/// Samples of one level of one light, for one ring.
#[derive(Debug)]
struct Draw {
    light: u32,
    ring: u32,
    level: u32,
    refines: bool,
    block: Tracked<Buffer>,
    group: BindGroup,
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

    /// Bytes that a plan takes for a mesh.
    pub(crate) fn bytes(&self, plan: &Plan, outline: &Outline) -> u64 {
        let levels = Levels::new(outline, plan.light_texels);
        let size = plan.map_size();
        let half = |size| TextureSpec::target("", size, HALF).bytes();
        let rings: u64 = (0..levels.rings).map(|ring| half(ring_size(size, ring))).sum();
        4 * half(size) + TextureSpec::target("", size, DEPTH).bytes() + rings + plan.light_bytes(levels.count())
    }
}

/// Texels of a ring's target, when the finest has `size`.
fn ring_size(size: [u32; 2], ring: u32) -> [u32; 2] {
    size.map(|side| side.div_ceil(1 << ring).max(1))
}

impl Buffers {
    pub(crate) fn new(
        gpu: &Gpu,
        passes: &Passes,
        material: &SplatMaterial,
        common: &Common,
        lights: &LightViews,
        plan: &Plan,
        outline: &Outline,
    ) -> Result<Self> {
        material.planes.expect(passes.storage)?;
        let levels = Levels::new(outline, plan.light_texels);
        let size = plan.map_size();
        let target = |label, size| gpu.texture(&TextureSpec::target(label, size, HALF));
        let visible = [target("positions", size)?, target("places", size)?, target("albedos", size)?];
        let rings = (0..levels.rings).map(|ring| target("ring", ring_size(size, ring)));
        let rings: Vec<Surface2d> = rings.collect::<Result<_>>()?;
        let collapsed = target("rings together", size)?;
        let texture = BindingResource::TextureView;
        let of_albedo = [texture(&material.albedo.all), BindingResource::Sampler(&material.albedo.sampler)];

        let which: Vec<Tracked<Buffer>> =
            (0..plan.lights).map(|light| gpu.uniform("which light", &Which { light, pad: [0; 3] })).collect();
        let mut reductions = Vec::new();
        for (block, light) in which.iter().zip(0..) {
            for level in 1..levels.count() {
                let from = lights.surfaces().each_ref().map(|surface| layers_of_level(surface, level - 1));
                let mut group = vec![block.as_entire_binding()];
                group.extend(from.iter().map(BindingResource::TextureView));
                reductions.push(Reduction {
                    light,
                    group: passes.reduce.bind(gpu, 0, &group)?,
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

        let rings_block = gpu.uniform("rings", &Rings::default());
        let mut of_collapse =
            vec![rings_block.as_entire_binding(), texture(&visible[0].view), texture(&visible[2].view)];
        // Rings that do not exist are never read.
        of_collapse.extend((0..MAX_RINGS).map(|ring| texture(&rings[ring.min(rings.len() - 1)].view)));
        let upsampling = gpu.uniform("upsampling", &Upsampling::default());
        let of_shade =
            [of_albedo[0].clone(), of_albedo[1].clone(), upsampling.as_entire_binding(), texture(&collapsed.view)];
        Ok(Self {
            view: [
                passes.view.bind(gpu, 0, &[common.block.as_entire_binding()])?,
                passes.view.bind(gpu, 1, &of_albedo)?,
            ],
            material: passes.splat.bind(gpu, 0, &material.planes.resources())?,
            collapse: passes.collapse.bind(gpu, 0, &of_collapse)?,
            shade: passes.shade.bind(gpu, 1, &of_shade)?,
            depth: gpu.texture(&TextureSpec::attachment("map depth", size, DEPTH))?,
            levels,
            visible,
            rings,
            collapsed,
            reductions,
            draws,
            rings_block,
            upsampling,
            which,
            softened: material.softened.map(|[r, g, b]| [r, g, b, 0.0]),
            pitch_mm: outline.header.pitch_mm,
            size,
        })
    }

    /// Tells the passes where lights and eye are.
    pub(crate) fn update(&mut self, gpu: &Gpu, scene: &Scene, block: &uniform::Scene, plan: &Plan) {
        let upsampling = plan.upsampling(&scene.view, block.middle_mm);
        gpu.queue.write_buffer(&self.upsampling, 0, bytemuck::bytes_of(&upsampling));
        let rings = Rings { count: self.levels.rings, near_mm: upsampling.near_mm, pad: [0; 2] };
        gpu.queue.write_buffer(&self.rings_block, 0, bytemuck::bytes_of(&rings));

        #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
        let [width, height] = plan.size.map(|side| side as f32);
        let cotangent = 1.0 / (0.5 * scene.view.angle).tan();
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
                softened: self.softened,
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
    }

    pub(crate) fn record(
        &self,
        mut encoder: CommandEncoder,
        passes: &Passes,
        mesh: &GpuMesh,
        lights: usize,
        plan: &Plan,
        lap: Lap<'_>,
    ) -> CommandEncoder {
        let lit = |light: u32| (light as usize) < lights;
        for reduction in self.reductions.iter().filter(|reduction| lit(reduction.light)) {
            let targets = reduction.targets.each_ref();
            passes.reduce.record(&mut encoder, &targets, &[&reduction.group], Rows::all(reduction.size));
        }
        encoder = lap("reduce", encoder);
        let clears = [FAR, Color::TRANSPARENT, Color::TRANSPARENT];
        let targets = [0, 1, 2].map(|k| Target { view: &self.visible[k].view, clear: clears[k], resolved: None });
        let [scene, albedo] = &self.view;
        passes.view.record(&mut encoder, &targets, &self.depth.view, &[scene, albedo], mesh);
        encoder = lap("view", encoder);
        for (ring, number) in self.rings.iter().zip(0..) {
            let draws = self.draws.iter().filter(|draw| draw.ring == number && lit(draw.light));
            let squares = |draw: &Draw| (plan.light_texels >> draw.level).max(1).pow(2);
            let draws: Vec<_> = draws.map(|draw| (&draw.group, squares(draw))).collect();
            passes.splat.record(&mut encoder, &ring.view, &self.material, &draws);
        }
        encoder = lap("splat", encoder);
        passes.collapse.record(&mut encoder, &[&self.collapsed.view], &[&self.collapse], Rows::all(self.size));
        lap("collapse", encoder)
    }
}
