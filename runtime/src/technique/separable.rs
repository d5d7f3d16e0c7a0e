//! The separable path on the screen: weighted irradiance where the eye sees the mesh, blurred by distances in space.

use subsurf_scene::Scene;
use subsurf_shaders::separable::MAX_TERMS;
use subsurf_shaders::source::{self, Domain};
use subsurf_shaders::uniform::{self, ScreenDomain, Upsampling};
use wgpu::{BindGroup, BindingResource, Buffer, Color, CommandEncoder, TextureFormat};

use super::cascade::{BlurPasses, Cascade};
use super::common::{COMMON, Common, Lap, encoding_of};
use super::light_views::{FAR, LightViews};
use super::mesh_pass::{MeshPass, Target};
use crate::asset::{GpuMesh, SeparableMaterial};
use crate::error::{Error, Result};
use crate::frame::plan::Plan;
use crate::gpu::{DEPTH, Gpu, Slot, Surface2d, TextureSpec, Tracked};

/// Its pipelines.
#[derive(Debug)]
pub(crate) struct Passes {
    terms: usize,
    weigh: MeshPass,
    blur: BlurPasses,
    pub(crate) shade: MeshPass,
}

/// Its buffers, for one size of picture.
#[derive(Debug)]
pub(crate) struct Buffers {
    cascade: Cascade,
    depth: Surface2d,
    domain: Tracked<Buffer>,
    upsampling: Tracked<Buffer>,
    weigh: [BindGroup; 2],
    pub(crate) shade: BindGroup,
    /// Maps where nothing is seen.
    far: Color,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, terms: usize, format: TextureFormat, samples: u32) -> Result<Self> {
        if !(1..=MAX_TERMS).contains(&terms) {
            return Err(Error::Device(format!("L = {terms}; factors have 1 to {MAX_TERMS} terms")));
        }
        let through = [Slot::FilteredLayers, Slot::Sampler, Slot::Uniform, Slot::KeptLayers, Slot::KeptLayers];
        let of_weigh: [&[Slot]; 2] = [&COMMON[..2], &through];
        let of_shade = [Slot::FilteredLayers, Slot::Sampler, Slot::Uniform, Slot::KeptLayers];
        let shader = source::shade_sums(encoding_of(format), terms);
        Ok(Self {
            terms,
            weigh: MeshPass::new(gpu, source::weigh_mesh(terms), "weigh", &of_weigh, &vec![gpu.kept(); 2 * terms], 1)?,
            blur: BlurPasses::new(gpu, Domain::Screen, terms)?,
            shade: MeshPass::new(gpu, shader, "shade", &[&COMMON, &of_shade], &[format], samples)?,
        })
    }

    pub(crate) fn bytes(&self, plan: &Plan) -> u64 {
        let size = plan.map_size();
        let depth = TextureSpec::target("", size, DEPTH).bytes();
        Cascade::bytes_of(size, self.terms) + depth + plan.light_bytes(1)
    }
}

impl Buffers {
    pub(crate) fn new(
        gpu: &Gpu,
        passes: &Passes,
        material: &SeparableMaterial,
        common: &Common,
        lights: &LightViews,
        plan: &Plan,
    ) -> Result<Self> {
        material.expect(passes.terms)?;
        let size = plan.map_size();
        let domain = gpu.uniform("screen", &ScreenDomain::default());
        let cascade = Cascade::new(gpu, &passes.blur, material, &domain.as_entire_binding(), size)?;
        let upsampling = gpu.uniform("upsampling", &Upsampling::default());
        let texture = BindingResource::TextureView;
        let factors = [texture(&material.layers.all), BindingResource::Sampler(&material.layers.sampler)];
        let of_weigh = [
            factors[0].clone(),
            factors[1].clone(),
            material.through().as_entire_binding(),
            texture(&lights.all[1]),
            texture(&lights.all[2]),
        ];
        let of_scene = [common.block.as_entire_binding(), texture(&lights.all[0])];
        let of_shade =
            [factors[0].clone(), factors[1].clone(), upsampling.as_entire_binding(), texture(&cascade.sums().all)];
        Ok(Self {
            weigh: [passes.weigh.bind(gpu, 0, &of_scene)?, passes.weigh.bind(gpu, 1, &of_weigh)?],
            shade: passes.shade.bind(gpu, 1, &of_shade)?,
            depth: gpu.texture(&TextureSpec::attachment("map depth", size, DEPTH))?,
            far: gpu.kept_colour(FAR),
            cascade,
            domain,
            upsampling,
        })
    }

    /// Tells the passes how large things are on the screen.
    pub(crate) fn update(&mut self, gpu: &Gpu, scene: &Scene, block: &uniform::Scene, plan: &Plan, jitters: bool) {
        let domain = ScreenDomain {
            size: plan.map_size(),
            focal_texels: plan.texels_per_tangent(&scene.camera) * block.pitch_mm,
            middle_mm: block.middle_mm,
            pitch_mm: block.pitch_mm,
            jitters: u32::from(jitters),
            pad: [0; 2],
        };
        gpu.queue.write_buffer(&self.domain, 0, bytemuck::bytes_of(&domain));
        gpu.queue.write_buffer(
            &self.upsampling,
            0,
            bytemuck::bytes_of(&plan.upsampling(&scene.camera, block.middle_mm)),
        );
    }

    pub(crate) fn record(
        &self,
        mut encoder: CommandEncoder,
        passes: &Passes,
        mesh: &GpuMesh,
        lap: Lap<'_>,
    ) -> CommandEncoder {
        let layers = self.cascade.maps[0].layers.iter().chain(&self.cascade.begun_sums().layers);
        let targets: Vec<_> = layers.map(|view| Target { view, clear: self.far, resolved: None }).collect();
        let [scene, factors] = &self.weigh;
        passes.weigh.record(&mut encoder, &targets, &self.depth.view, &[scene, factors], mesh);
        encoder = lap("weigh", encoder);
        self.cascade.record(&mut encoder, &passes.blur, None);
        lap("blur", encoder)
    }
}
